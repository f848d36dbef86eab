"""Where an arm would touch what stands around it: convex hulls of its links against boxes.

Pinocchio places the links, coal tests the pairs.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from robots.body import HeldBox
from robots.motion.kinematics import Joints
from robots.vision.seen_box import SeenBox

_QHULL_OPTIONS = "Qt"
"""Triangles: what coal calls the convex representation of a mesh is that only if it is convex."""


@dataclass(frozen=True, slots=True)
class Hand:
    """How the gripper is on a way: the angles of its joints, and what it holds."""

    angles_rad: Mapping[str, float]
    held: Sequence[HeldBox] = ()


@dataclass(frozen=True, slots=True)
class Margins:
    """How far an arm keeps from something: its links, and its gripper with what that holds."""

    arm_m: float
    hand_m: float


@dataclass(slots=True)
class _Pairs:
    """A geometry model with what one hand could touch, and whose box each pair is about."""

    model: Any
    data: Any
    boxes: list[SeenBox] = field(default_factory=list)


class CollisionModel:
    """The links of one arm that have a shape for collisions, as convex hulls."""

    def __init__(self, urdf: Path, joints: Sequence[str], tool_frame: str) -> None:
        """`joints` are those of the arm, in the order of its joint angles."""
        self._model = pin.buildModelFromUrdf(str(urdf))
        self._data = self._model.createData()
        self._links = pin.buildGeomFromUrdf(
            self._model, str(urdf), pin.GeometryType.COLLISION, package_dirs=[str(urdf.parent)]
        )
        for link in self._links.geometryObjects:
            link.geometry.buildConvexHull(True, _QHULL_OPTIONS)
            link.geometry = link.geometry.convex
        self._joints = list(joints)
        wrist = self._model.getJointId(joints[-1])
        self._beyond_wrist = [
            wrist in self._model.supports[link.parentJoint] for link in self._links.geometryObjects
        ]
        self._tool = self._model.frames[self._model.getFrameId(tool_frame)]

    def among(
        self, boxes: Sequence[SeenBox], hand: Hand, margins: Callable[[SeenBox], Margins]
    ) -> "Surrounded":
        """The arm with its gripper so, amid boxes from each of which it keeps away."""
        geometry = self._links.copy()
        moving = list(range(len(geometry.geometryObjects)))
        beyond_wrist = list(self._beyond_wrist)
        for number, held in enumerate(hand.held):
            placement = self._tool.placement * pin.SE3(held.in_tool)
            shape = coal.Box(*held.size)
            thing = pin.GeometryObject(f"held {number}", self._tool.parentJoint, placement, shape)
            moving.append(geometry.addGeometryObject(thing))
            beyond_wrist.append(True)
        pairs, kept_m = _Pairs(geometry, None), []
        for number, box in enumerate(boxes):
            thing = pin.GeometryObject(f"box {number}", 0, _placement(box), coal.Box(*box.size))
            index = geometry.addGeometryObject(thing)
            kept = margins(box)
            for link in moving:
                geometry.addCollisionPair(pin.CollisionPair(link, index))
                pairs.boxes.append(box)
                kept_m.append(kept.hand_m if beyond_wrist[link] else kept.arm_m)
        pairs.data = pin.GeometryData(geometry)
        for request, margin_m in zip(pairs.data.collisionRequests, kept_m, strict=True):
            request.security_margin = margin_m
        return Surrounded(self, pairs, hand)

    def configuration(self, joints: Joints, hand: Hand) -> Any:
        """All joints as pinocchio counts them: unlimited ones by cosine and sine."""
        angles = dict(zip(self._joints, joints, strict=True)) | dict(hand.angles_rad)
        whole = pin.neutral(self._model)
        for name, angle in angles.items():
            joint = self._model.joints[self._model.getJointId(name)]
            if joint.nq == 1:
                whole[joint.idx_q] = angle
            else:
                whole[joint.idx_q : joint.idx_q + 2] = np.cos(angle), np.sin(angle)
        return whole

    def hits(self, pairs: _Pairs, whole: Any, *, first: bool) -> list[SeenBox]:
        """The boxes that anything touches, or the `first` of them only."""
        touched = pin.computeCollisions(
            self._model, self._data, pairs.model, pairs.data, whole, first
        )
        if not touched:
            return []
        results = zip(pairs.data.collisionResults, pairs.boxes, strict=True)
        return [box for result, box in results if result.isCollision()]


@dataclass(frozen=True, slots=True)
class Surrounded:
    """An arm amid boxes."""

    arm: CollisionModel
    _pairs: _Pairs
    _hand: Hand

    def hit(self, joints: Joints) -> SeenBox | None:
        """What the arm touches at these joint angles; None if nothing."""
        return next(iter(self._hits(joints, first=True)), None)

    def hits(self, joints: Joints) -> frozenset[SeenBox]:
        """All that the arm touches at these joint angles."""
        return frozenset(self._hits(joints, first=False))

    def _hits(self, joints: Joints, *, first: bool) -> list[SeenBox]:
        if not self._pairs.boxes:
            return []
        whole = self.arm.configuration(joints, self._hand)
        return self.arm.hits(self._pairs, whole, first=first)


def _placement(box: SeenBox) -> Any:
    x, y, z = box.x, box.y, box.bottom_z + box.size[2] / 2
    turn = pin.utils.rotate("z", box.yaw)
    return pin.SE3(turn, np.array([x, y, z]))
