"""Where an arm would touch what stands around it: convex hulls of its links against boxes.

Pinocchio places the links, coal tests the pairs; a tree of their bounding boxes leaves out most.
"""

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mend.robots.arm.body import HeldBox
from mend.robots.arm.motion.kinematics import Joints
from mend.robots.vision.seen_box import SeenBox

_QHULL_OPTIONS = "Qt"
"""Triangles: what coal calls the convex representation of a mesh is that only if it is convex."""


@dataclass(frozen=True, slots=True)
class HandPosture:
    """How the gripper is on a way: the angles of its joints, and what it holds."""

    angles_rad: Mapping[str, float]
    held: Sequence[HeldBox] = ()


@dataclass(frozen=True, slots=True)
class Margins:
    """How far an arm keeps from something: its links, and its gripper with what that holds."""

    arm_m: float
    hand_m: float


@dataclass(frozen=True, slots=True)
class _Pairs:
    """A geometry model with what one hand could touch, and whose box each pair is about."""

    model: Any
    data: Any
    tree: Any
    boxes: Sequence[SeenBox]


class CollisionModel:
    """The links of one arm that have a shape for collisions, as convex hulls."""

    def __init__(self, urdf: Path, joints: Sequence[str], tool_frame: str) -> None:
        """`joints` are those of the arm, in the order of its joint angles."""
        self._model, self._links = _read(urdf, urdf.stat().st_mtime_ns)
        self._data = self._model.createData()
        self._joints = list(joints)
        places = [self._model.joints[self._model.getJointId(each)] for each in joints]
        self._unlimited = np.array([place.nq == 2 for place in places])
        self._first = np.array([place.idx_q for place in places])
        wrist = self._model.getJointId(joints[-1])
        self._beyond_wrist = [
            wrist in self._model.supports[link.parentJoint] for link in self._links.geometryObjects
        ]
        self._tool = self._model.frames[self._model.getFrameId(tool_frame)]

    def among(
        self, boxes: Sequence[SeenBox], hand: HandPosture, margins: Callable[[SeenBox], Margins]
    ) -> "Surrounded":
        """The arm with its gripper so, amid boxes from each of which it keeps away."""
        geometry = pin.GeometryModel()
        for number, box in enumerate(boxes):
            shape = coal.Box(*box.size)
            thing = pin.GeometryObject(f"box {number}", 0, _placement(box), shape)
            geometry.addGeometryObject(thing)
        for link in self._links.geometryObjects:
            geometry.addGeometryObject(link)
        for number, held in enumerate(hand.held):
            placement = self._tool.placement * pin.SE3(held.in_tool)
            shape = coal.Box(*held.size)
            thing = pin.GeometryObject(f"held {number}", self._tool.parentJoint, placement, shape)
            geometry.addGeometryObject(thing)
        beyond_wrist = np.array([*self._beyond_wrist, *(True for _ in hand.held)])
        return Surrounded(
            self, self._pairs(geometry, boxes, beyond_wrist, margins), self.with_hand(hand)
        )

    def _pairs(
        self,
        geometry: Any,
        boxes: Sequence[SeenBox],
        beyond_wrist: NDArray[np.bool_],
        margins: Callable[[SeenBox], Margins],
    ) -> _Pairs:
        """Each box with everything that moves: in `geometry` the boxes come first."""
        count = len(geometry.geometryObjects)
        paired = np.zeros((count, count), np.bool_)
        paired[: len(boxes), len(boxes) :] = True
        kept_m = np.zeros((count, count))
        for number, box in enumerate(boxes):
            kept = margins(box)
            kept_m[number, len(boxes) :] = np.where(beyond_wrist, kept.hand_m, kept.arm_m)
        geometry.setCollisionPairs(paired)
        data = pin.GeometryData(geometry)
        data.setSecurityMargins(geometry, kept_m)
        _forget_guesses(data)
        tree = pin.BroadPhaseManager_DynamicAABBTreeCollisionManager(self._model, geometry, data)
        return _Pairs(geometry, data, tree, [box for box in boxes for _ in beyond_wrist])

    def with_hand(self, hand: HandPosture) -> NDArray[np.float64]:
        """All joints as pinocchio counts them (`with_joints`), with the gripper so."""
        whole = pin.neutral(self._model)
        for name, angle_rad in hand.angles_rad.items():
            whole[self._model.joints[self._model.getJointId(name)].idx_q] = angle_rad
        return np.asarray(whole)

    def with_joints(self, whole: NDArray[np.float64], joints: Joints) -> NDArray[np.float64]:
        """The same with the arm's joint angles: of unlimited joints cosine and sine."""
        turned = whole.copy()
        turned[self._first] = np.where(self._unlimited, np.cos(joints), joints)
        turned[self._first[self._unlimited] + 1] = np.sin(joints[self._unlimited])
        return turned

    def hits(self, pairs: _Pairs, whole: Any, *, first: bool) -> list[SeenBox]:
        """The boxes that anything touches, or the `first` of them only."""
        if not pin.computeCollisions(self._model, self._data, pairs.tree, whole, True):
            return []
        # By the tree only whether anything is touched is told: what it leaves out keeps its result.
        pin.computeCollisions(self._model, self._data, pairs.model, pairs.data, whole, first)
        results = zip(pairs.data.collisionResults, pairs.boxes, strict=True)
        return [box for result, box in results if result.isCollision()]


@dataclass(frozen=True, slots=True)
class Surrounded:
    """An arm amid boxes."""

    arm: CollisionModel
    _pairs: _Pairs
    _whole: NDArray[np.float64]

    def hit(self, joints: Joints) -> SeenBox | None:
        """What the arm touches at these joint angles; None if nothing."""
        return next(iter(self._hits(joints, first=True)), None)

    def hits(self, joints: Joints) -> frozenset[SeenBox]:
        """All that the arm touches at these joint angles."""
        return frozenset(self._hits(joints, first=False))

    def _hits(self, joints: Joints, *, first: bool) -> list[SeenBox]:
        if not self._pairs.boxes:
            return []
        whole = self.arm.with_joints(self._whole, joints)
        return self.arm.hits(self._pairs, whole, first=first)


@lru_cache(maxsize=4)
def _read(urdf: Path, _changed_ns: int) -> tuple[Any, Any]:
    """A robot's joints, and the hulls of its links: they stay as they are, for all robots alike."""
    model = pin.buildModelFromUrdf(str(urdf))
    links = pin.buildGeomFromUrdf(
        model, str(urdf), pin.GeometryType.COLLISION, package_dirs=[str(urdf.parent)]
    )
    for link in links.geometryObjects:
        if isinstance(link.geometry, coal.BVHModelBase):
            link.geometry.buildConvexHull(True, _QHULL_OPTIONS)
            link.geometry = link.geometry.convex
    return model, links


_FILTERING = Lock()
"""What one thread has warnings filtered by, another would take back amid its work."""


def _forget_guesses(data: Any) -> None:
    """Let every test begin anew: coal, begun where the last one ended, misses some that touch."""
    with _FILTERING, warnings.catch_warnings():
        # Pinocchio asks for it by what coal has given another name, and only that takes it back.
        warnings.simplefilter("ignore", DeprecationWarning)
        for request in data.collisionRequests:
            request.enable_cached_gjk_guess = False


def _placement(box: SeenBox) -> Any:
    x, y, z = box.x, box.y, box.bottom_z + box.size[2] / 2
    cos, sin = math.cos(box.yaw), math.sin(box.yaw)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return pin.SE3(turn, np.array([x, y, z]))
