"""One part on the table: what it is, where it is and who has it."""

import math
from dataclasses import dataclass
from enum import StrEnum

from mend.tasks.footprint import Footprint
from mend.tasks.part_boxes import boxes_of, height_of
from mend.tasks.scene import SceneObject


class Whereabouts(StrEnum):
    """Who or what has a part."""

    RESTING = "resting"
    """It lies on the table or on other parts."""
    HELD = "held"
    """The robot's fingers hold it."""
    WITH_PERSON = "with_person"
    """A person holds it; `Part.shown` says whether it can be seen."""
    GONE = "gone"
    """A person took it away."""


_TRANSITIONS = {
    Whereabouts.RESTING: {Whereabouts.HELD, Whereabouts.WITH_PERSON, Whereabouts.GONE},
    Whereabouts.HELD: {Whereabouts.RESTING, Whereabouts.WITH_PERSON, Whereabouts.GONE},
    Whereabouts.WITH_PERSON: {Whereabouts.RESTING, Whereabouts.HELD, Whereabouts.GONE},
    Whereabouts.GONE: {Whereabouts.RESTING, Whereabouts.WITH_PERSON},
}


@dataclass(frozen=True, slots=True)
class UprightPose:
    """Where the bottom centre of an upright part is, in the base frame."""

    x: float
    y: float
    z: float
    yaw: float


@dataclass(frozen=True, slots=True)
class GraspBox:
    """What fingers close on: full extents in the part's frame, and heights above its bottom."""

    extent_x: float
    extent_y: float
    low: float
    high: float

    @property
    def thin_yaw(self) -> float:
        """The direction of the thinner extent in the part's frame."""
        return 0.0 if self.extent_x <= self.extent_y else math.pi / 2

    def half_width(self, direction: float) -> float:
        """Half of how wide it is along a direction given in the part's frame."""
        return (
            abs(self.extent_x * math.cos(direction)) + abs(self.extent_y * math.sin(direction))
        ) / 2


class TablePart:
    """A part of the scene."""

    def __init__(self, name: str, definition: SceneObject, start: UprightPose) -> None:
        self.name = name
        self.color = definition.color
        self.size = definition.size
        self.knob = definition.knob
        self.start = start
        self.pose = start
        """Where it is; while it is gone, where it last was."""
        self.last_rest = start
        """Where it rested last, for a world that is rebuilt while it is in the air."""
        self.shown = True
        self._whereabouts = Whereabouts.RESTING

    @property
    def whereabouts(self) -> Whereabouts:
        return self._whereabouts

    @property
    def visible(self) -> bool:
        """Whether a camera could see it."""
        return self.shown and self._whereabouts is not Whereabouts.GONE

    @property
    def height(self) -> float:
        """From its bottom to its highest point."""
        return height_of(self.size, self.knob)

    @property
    def footprint(self) -> Footprint:
        """The ground that it covers."""
        return self.footprint_at(self.pose)

    def footprint_at(self, pose: UprightPose) -> Footprint:
        """The ground that it would cover."""
        return Footprint(pose.x, pose.y, pose.yaw, self.size[0], self.size[1])

    @property
    def grasp_box(self) -> GraspBox:
        low_m, (extent_x, extent_y, _) = boxes_of(self.size, self.knob)[-1]
        return GraspBox(extent_x, extent_y, low_m, self.height)

    def give_to(self, whereabouts: Whereabouts, *, shown: bool = True) -> None:
        """Change who has the part. Raises `ValueError` when it cannot pass between these two."""
        if whereabouts is not self._whereabouts and (
            whereabouts not in _TRANSITIONS[self._whereabouts]
        ):
            allowed = ", ".join(sorted(_TRANSITIONS[self._whereabouts]))
            raise ValueError(
                f"part '{self.name}' is {self._whereabouts}: expected one of {allowed} next, "
                f"not {whereabouts}"
            )
        self._whereabouts = whereabouts
        self.shown = shown

    def rest_at(self, pose: UprightPose) -> None:
        """Lie at a pose from now on."""
        self.give_to(Whereabouts.RESTING)
        self.pose = pose
        self.last_rest = pose
