"""What stands around an arm on a planned path, segment by segment."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.motion.collision import CollisionModel, Hand, Margins, Surrounded
from robots.motion.curve import JointCurve
from robots.motion.kinematics import Joints
from robots.motion.planner import JointPath, PathSegment
from robots.vision.seen_box import SeenBox

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
class PathObstacles:
    """Boxes around an arm whose gripper is like `hands[i]` on segment i of a path."""

    free: Sequence[Surrounded]
    straight: Sequence[Surrounded]

    @classmethod
    def around(
        cls, arm: CollisionModel, boxes: Sequence[SeenBox], hands: Sequence[Hand], start: Joints
    ) -> "PathObstacles":
        """What is near where the path begins is kept away from less; what is touched there is left.

        `start` are the joint angles of the beginning.
        """
        if not hands:
            return cls([], [])
        near = arm.among(boxes, hands[0], lambda _: _FREE).hits(start)
        touched = arm.among(boxes, hands[0], lambda _: _NONE).hits(start)
        free, straight = [], []
        for number, hand in enumerate(hands):
            others = [box for box in boxes if number > 0 or box not in touched]
            free.append(arm.among(others, hand, lambda box: _NONE if box in near else _FREE))
            straight.append(
                arm.among(others, hand, lambda box: _NONE if box in near else _STRAIGHT)
            )
        return cls(free, straight)

    def first_on(self, path: JointPath) -> SeenBox | None:
        """What the arm would touch first on a path; None if nothing."""
        hits = (self.on(number, way) for number, way in enumerate(path.ways))
        return next((hit for hit in hits if hit is not None), None)

    def on(self, number: int, way: PathSegment) -> SeenBox | None:
        """What it would touch on segment `number` of a path; None if nothing."""
        surrounded = (self.straight if way.straight else self.free)[number]
        for joints in samples(way.curve):
            hit = surrounded.hit(joints)
            if hit is not None:
                return hit
        return None

    def is_free(self, number: int, joints: Joints) -> bool:
        """Whether it touches nothing at these joint angles on such a segment, by a free way."""
        return self.free[number].hit(joints) is None


def samples(curve: JointCurve) -> list[Joints]:
    """Joint angles along a curve, the end among them."""
    turned = float(np.abs(curve.end - curve.start).max())
    count = max(_FEWEST_SAMPLES, round(turned / _STEP_RAD))
    return [curve.at(float(at)) for at in np.linspace(0.0, curve.length, count + 1)[1:]]
