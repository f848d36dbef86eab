"""What a run may choose about a workcell."""

from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from tasks.scene import StrictModel


class WorkcellOptions(StrictModel):
    """What a run may choose about the world.

    `renderer`: `bullet` draws forearm pictures at 10 Hz, `fast` at 30 Hz. `camera_noise`:
    standard deviation of each colour channel in grey levels of 255. `light`: how far light and
    exposure vary by the seed and with time, from 0 (not at all) to 1. `depth_noise`: how noisy the
    head camera's depth is, from 0 (not at all) to 1 (as a Kinect's).
    """

    renderer: Literal["bullet", "fast"] = "fast"
    camera_noise: Annotated[float, Field(ge=0.0, le=30.0, strict=False)] = 0.0
    light: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    depth_noise: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 1.0


def read_options(options: dict[str, Any]) -> WorkcellOptions:
    """Raises `ValueError` with one sentence that says which option is wrong."""
    try:
        return WorkcellOptions.model_validate(options)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ValueError(f"world option '{where}' of the workcell: {first['msg']}") from error
