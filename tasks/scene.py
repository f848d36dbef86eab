"""Scenes: the objects and places that a task file speaks of, and where the robots stand.

All lengths are metres, angles radians, poses in the scene's frame (z up), which is that of a robot
that stands alone: x forward, y left of it.
"""

import math
from typing import Annotated

from pydantic import AfterValidator, Field, JsonValue

from mend.documents.spellings import NAME
from mend.documents.strict_model import StrictModel
from mend.documents.unit import Unit

Metres = Annotated[float, Field(ge=-10_000.0, le=10_000.0, allow_inf_nan=False), Unit("metres")]
Length = Annotated[float, Field(gt=1e-6, le=10.0, allow_inf_nan=False), Unit("metres")]
Radians = Annotated[float, Field(ge=-6.2832, le=6.2832, allow_inf_nan=False), Unit("radians")]
Name = Annotated[str, Field(pattern=NAME)]
Channel = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
LinearRgb = Annotated[
    tuple[Channel, Channel, Channel], Unit("red, green and blue, each from 0 to 1")
]
FullExtents = Annotated[tuple[Length, Length, Length], Unit("lengths along x, y and z in metres")]

MOST_ROBOTS = 64
QUARTER = math.pi / 2
_OFF_QUARTER_RAD = 0.01


def _quarter_turns(yaw: float) -> float:
    """A table has to stay an upright box in every robot's frame."""
    turns = round(yaw / QUARTER)
    if abs(yaw - turns * QUARTER) > _OFF_QUARTER_RAD:
        raise ValueError("must be a multiple of a quarter of a turn (1.5708)")
    return turns * QUARTER


QuarterTurns = Annotated[Radians, AfterValidator(_quarter_turns)]

RESTS_M = 0.006
"""What is so near to a surface rests on it."""


class Pose(StrictModel):
    """Where the bottom centre of something is; `z` None means on the table."""

    x: Metres
    y: Metres
    z: Metres | None = None
    yaw: Radians = 0.0


class SceneObject(StrictModel):
    """A part: a coloured box, or a plate with a knob to grasp it by.

    `color` is linear RGB in [0, 1]; `size` the full extents x, y, z; `knob` the full extents of a
    box on top of the plate. A gripper closes across the thinner horizontal extent of what it
    grasps (the knob where there is one).
    """

    color: LinearRgb
    size: FullExtents
    knob: FullExtents | None = None
    pose: Pose
    mass_kg: Annotated[float, Field(gt=0.0, le=50.0)] = 0.12
    needs_help: bool = False


class Place(StrictModel):
    """A target: where the bottom centre of an object is to rest."""

    pose: Pose


class Table(StrictModel):
    """The work surface: an upright box whose top is at `height`."""

    height: Metres = 0.70
    center: tuple[Metres, Metres] = (0.70, -0.10)
    size: tuple[Length, Length] = (0.70, 1.30)

    def is_under(self, x: float, y: float) -> bool:
        """Whether a point of the plane is over the table."""
        return (
            abs(x - self.center[0]) <= self.size[0] / 2
            and abs(y - self.center[1]) <= self.size[1] / 2
        )


class Base(StrictModel):
    """Where a robot stands: its base frame (x forward, y left) in the scene's.

    `z` is the height of the floor that it stands on.
    """

    x: Metres
    y: Metres
    z: Metres = 0.0
    yaw: QuarterTurns = 0.0


DRAWN_APART_M = 0.004
"""A start that is drawn nearer to another part is drawn anew."""


class Scatter(StrictModel):
    """How far a world may move an object's start pose, uniformly, by its seed."""

    xy: Annotated[float, Field(ge=0.0, le=0.5)] = 0.0
    yaw: Annotated[float, Field(ge=0.0, le=3.15)] = 0.0


class Scene(StrictModel):
    """Everything that a task's leaves may name. Without `robots` one stands in the middle.

    `setting`: what a kind of world needs besides, and checks itself, as a building its floors.
    """

    name: Name
    table: Table = Table()
    objects: dict[Name, SceneObject]
    places: dict[Name, Place]
    scatter: Scatter = Scatter()
    robots: Annotated[dict[Name, Base], Field(max_length=MOST_ROBOTS)] = {}
    setting: dict[str, JsonValue] = {}
