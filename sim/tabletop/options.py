"""What a run may choose about a tabletop."""

from typing import Annotated

from pydantic import ConfigDict, Field

from mend.documents.strict_model import StrictModel

REACH_MIN_M = 0.40
"""Nearer to its base no robot can grasp."""


class TabletopOptions(StrictModel):
    """What a run may choose about the world."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    camera_noise: Annotated[float, Field(ge=0.0, le=30.0, strict=False)] = 0.0
    """Standard deviation of each colour channel of the cameras, in grey levels of 255."""
    light: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """How far light and exposure vary by the seed and with time, from 0 (not at all) to 1."""
    depth_noise: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """How noisy the head camera's depth is, from 0 (not at all) to 1 (as a Kinect's)."""
    reach_m: Annotated[float, Field(ge=REACH_MIN_M, le=10.0, strict=False)] | None = None
    """How far from its base the robot can grasp, in metres; null: at least to every place."""
