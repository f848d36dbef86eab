"""The expectation that an object stands where the arm can lift it."""

import math
from collections.abc import Sequence

from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.behaviors.grasp_choice import others
from mend.robots.arm.behaviors.pick_and_place import lifting
from mend.robots.arm.behaviors.planning import Plan, at_once, plan_amid
from mend.robots.arm.grasp import can_grasp
from mend.robots.arm.looks.looker import Looker
from mend.robots.arm.looks.shown import detection_of
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Detection, Location
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.seen_box import SeenBox

_STILL_M = 0.006
"""An object is at rest if it is this near to where the look before saw it."""

_Spot = tuple[str | None, float, float, float]
"""What stands somewhere: its name, x, y and height."""


class InReach:
    """An object rests, standing, where the arm can lift it amid all that is seen."""

    def __init__(self, looker: Looker, part: Part) -> None:
        self._looker, self._part = looker, part
        self._before: HeadSighting | None = None
        self._barred: Sequence[_Spot] = ()

    def is_fulfilled(self) -> bool:
        if not can_grasp(self._part, self._looker.arm.body.gripper):
            return False
        perception, image = self._looker.perception, self._looker.look_at_table()
        if image is None:
            return False
        before, self._before = self._before, perception.head.sight(self._part, image)
        now = self._before
        if before is None or now is None or now.toppled:
            return False
        moved_m = math.dist((now.x, now.y, now.z), (before.x, before.y, before.z))
        if moved_m > _STILL_M:
            return False
        return self._can_lift(now, others(self._part, perception.head.seen_boxes(image)))

    def detection(self, image: CameraImage) -> Detection:
        perception = self._looker.perception
        sighting = perception.head.sight(self._part, image)
        return detection_of(perception, image, self._part, sighting, None)

    def _can_lift(self, at: HeadSighting, around: Sequence[SeenBox]) -> bool:
        """Whether there is a plan for that; where there was none, only once something has moved."""
        spots = [(None, at.x, at.y, at.z), *((e.name, e.x, e.y, e.top_z) for e in around)]
        if _alike(spots, self._barred):
            return False
        body, table = self._looker.arm.body, self._looker.perception.catalogue.table
        errand = Errand(lifting, self._part, Location(x=at.x, y=at.y, z=at.z, yaw=at.yaw), None)
        plan = at_once(plan_amid(errand, body, table, around))
        self._barred = () if isinstance(plan, Plan) else spots
        return isinstance(plan, Plan)


def _alike(spots: Sequence[_Spot], before: Sequence[_Spot]) -> bool:
    """Whether the same things stand where they stood before."""
    return len(spots) == len(before) and all(
        one[0] == other[0] and math.dist(one[1:], other[1:]) <= _STILL_M
        for one, other in zip(spots, before, strict=True)
    )
