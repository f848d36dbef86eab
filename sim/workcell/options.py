"""What a run may choose about a workcell."""

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from mend.documents.strict_model import StrictModel


class WorkcellOptions(StrictModel):
    """What a run may choose about the world."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    renderer: Literal["bullet", "fast"] = "fast"
    """`bullet` draws the forearm camera's pictures at 10 Hz, `fast` at 30 Hz."""
    camera_noise: Annotated[float, Field(ge=0.0, le=30.0, strict=False)] = 0.0
    """Standard deviation of each colour channel of the cameras, in grey levels of 255."""
    light: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """How far light and exposure vary by the seed and with time, from 0 (not at all) to 1."""
    depth_noise: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 1.0
    """How noisy the head camera's depth is, from 0 (not at all) to 1 (as a Kinect's)."""
