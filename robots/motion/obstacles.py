"""What stands around an arm on a planned path, segment by segment."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.motion.collision import CollisionModel, Hand, Surrounded
from robots.motion.curve import JointCurve
from robots.motion.kinematics import Joints
from robots.motion.planner import JointPath, PathSegment
from robots.vision.seen_box import SeenBox

FREE_MARGIN_M = 0.008
"""Kept from everything on free ways; on straight ones into and out of gaps nothing more."""

_STEP_RAD = 0.06
_FEWEST_SAMPLES = 6


@dataclass(frozen=True, slots=True)
class PathObstacles:
    """Boxes around an arm whose gripper is like `hands[i]` on segment i of a path."""

    free: Sequence[Surrounded]
    straight: Sequence[Surrounded]
    known: frozenset[SeenBox]
    """What is touched where the path begins: it cannot be kept away from."""

    @classmethod
    def around(
        cls, arm: CollisionModel, boxes: Sequence[SeenBox], hands: Sequence[Hand], start: Joints
    ) -> "PathObstacles":
        free = [arm.among(boxes, hand, FREE_MARGIN_M) for hand in hands]
        straight = [arm.among(boxes, hand, 0.0) for hand in hands]
        touching = free[0].hit(start) if free else None
        return cls(free, straight, frozenset() if touching is None else frozenset({touching}))

    def first_on(self, path: JointPath) -> str | None:
        """What the arm would touch first on a path; None if nothing."""
        hits = (self.on(number, way) for number, way in enumerate(path.ways))
        return next((hit for hit in hits if hit is not None), None)

    def on(self, number: int, way: PathSegment) -> str | None:
        """What it would touch on segment `number` of a path; None if nothing."""
        surrounded = (self.straight if way.straight else self.free)[number]
        for joints in samples(way.curve):
            hit = surrounded.hit(joints)
            if hit is not None and hit not in self.known:
                return hit.name or "something unknown"
        return None

    def is_free(self, number: int, joints: Joints) -> bool:
        """Whether it touches nothing at these joint angles on such a segment, by a free way."""
        hit = self.free[number].hit(joints)
        return hit is None or hit in self.known


def samples(curve: JointCurve) -> list[Joints]:
    """Joint angles along a curve, the end among them."""
    turned = float(np.abs(curve.end - curve.start).max())
    count = max(_FEWEST_SAMPLES, round(turned / _STEP_RAD))
    return [curve.at(float(at)) for at in np.linspace(0.0, curve.length, count + 1)[1:]]
