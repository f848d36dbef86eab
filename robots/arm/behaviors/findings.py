"""What the head camera shows of an assignment: before the first step, and after the last."""

from collections.abc import Sequence
from dataclasses import dataclass

from mend.robots.arm.body import ToolPose
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.obstruction import Obstruction
from mend.robots.vision.presence import AT_PLACE_M, Presence, off_place_m

_EXACT_M = 0.006
"""The arm places a part less than 3 mm off, and the camera sees it less than 2 mm off."""


@dataclass(slots=True)
class Findings:
    """What was seen before the first step; `carrying`: the object is in the gripper already.

    `blind` says why the head camera shows nothing of the table, `refusal` why the object cannot be
    grasped and placed as it was seen. `obstruction` is what stands in `way`, through which the tool
    point is to go.
    """

    carrying: bool = False
    image: CameraImage | None = None
    blind: str | None = None
    sighting: HeadSighting | None = None
    refusal: str | None = None
    obstruction: Obstruction | None = None
    way: Sequence[ToolPose] = ()


@dataclass(frozen=True, slots=True)
class Outcome:
    """What the head camera showed once the arm was out of its view."""

    image: CameraImage
    sighting: HeadSighting | None
    presence: Presence
    blind: str | None = None
    """Why the picture shows nothing of the table, or of the object's place."""

    def is_inexact(self, part: Part, target: Location) -> bool:
        """Whether it is at its place, but could be placed better."""
        seen = self.sighting
        if self.presence is not Presence.THERE or seen is None:
            return False
        return is_inexact(seen, part, target)


def is_inexact(seen: HeadSighting, part: Part, target: Location) -> bool:
    """Whether what is at its place is wholly seen there, farther off than arm and camera err."""
    return seen.complete and _EXACT_M < off_place_m(seen, part, target) <= AT_PLACE_M
