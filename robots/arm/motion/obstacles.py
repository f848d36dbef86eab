"""What stands around an arm on a planned path, segment by segment."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mend.robots.arm.motion.collision import CollisionModel, HandPosture, Margins, Surrounded
from mend.robots.arm.motion.curve import JointCurve
from mend.robots.arm.motion.kinematics import Joints
from mend.robots.arm.motion.planner import PathSegment
from mend.robots.vision.seen_box import SeenBox

_FREE_M = 0.008
"""Kept from everything on free ways."""
_STRAIGHT_M = 0.005
"""Kept by the arm on straight ways; by the gripper, that goes into and out of gaps, nothing."""

_FREE = Margins(_FREE_M, _FREE_M)
_STRAIGHT = Margins(_STRAIGHT_M, 0.0)
_NONE = Margins(0.0, 0.0)

_STEP_RAD = 0.06
_FEWEST_SAMPLES = 6


@dataclass(frozen=True, slots=True)
class _Made:
    """An arm with such a hand amid such boxes, keeping so far away."""

    hand: HandPosture
    boxes: Sequence[SeenBox]
    kept: Margins
    surrounded: Surrounded


class PathObstacles:
    """Boxes around an arm whose gripper is like `hands[i]` on segment i of a path."""

    def __init__(
        self,
        arm: CollisionModel,
        boxes: Sequence[SeenBox],
        hands: Sequence[HandPosture],
        start: Joints,
    ) -> None:
        """What is near where the path begins is kept away from less; what is touched there is left.

        `start` are the joint angles of the beginning.
        """
        self._arm, self._hands, self._boxes = arm, hands, boxes
        self._near = arm.among(boxes, hands[0], lambda _: _FREE).hits(start) if hands else ()
        touched = (
            arm.among(list(self._near), hands[0], lambda _: _NONE).hits(start) if hands else ()
        )
        self._left = [box for box in boxes if box not in touched] if touched else boxes
        self._made: list[_Made] = []

    def on(self, number: int, way: PathSegment) -> SeenBox | None:
        """What it would touch on segment `number` of a path; None if nothing."""
        surrounded = self._surrounded(number, _STRAIGHT if way.straight else _FREE)
        for joints in samples(way.curve):
            hit = surrounded.hit(joints)
            if hit is not None:
                return hit
        return None

    def is_free(self, number: int, joints: Joints) -> bool:
        """Whether it touches nothing at these joint angles on such a segment, by a free way."""
        return self._surrounded(number, _FREE).hit(joints) is None

    def _surrounded(self, number: int, kept: Margins) -> Surrounded:
        """The arm on a segment; most segments are like one before, so it is made only once."""
        hand, boxes = self._hands[number], self._left if number == 0 else self._boxes
        for made in self._made:
            if made.boxes is boxes and made.kept is kept and made.hand == hand:
                return made.surrounded
        near = self._near
        surrounded = self._arm.among(boxes, hand, lambda box: _NONE if box in near else kept)
        self._made.append(_Made(hand, boxes, kept, surrounded))
        return surrounded


def samples(curve: JointCurve) -> list[Joints]:
    """Joint angles along a curve, the end among them."""
    turned = float(np.abs(curve.end - curve.start).max())
    count = max(_FEWEST_SAMPLES, round(turned / _STEP_RAD))
    return curve.along(np.linspace(0.0, curve.length, count + 1)[1:])
