"""Kinematics of a serial chain from a URDF: forward, geometric Jacobian, damped least squares."""

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.errors import WrongInputError
from mend.maps.compiled import compiled
from mend.robots.body import Matrix4

Joints = NDArray[np.float64]
"""Joint angles in radians, shape (n,)."""

_CONTINUOUS_LIMIT_RAD = 1.99 * math.pi
"""Joints without limits may turn this far, so that a plan never winds up cables."""

_POSITION_TOLERANCE_M = 1e-4
_ROTATION_TOLERANCE_RAD = 5e-4
_DAMPING = 1e-3
_MAX_STEP_RAD = 0.3


class KinematicChain:
    """The revolute joints between a URDF's root and one of its links, all others at zero."""

    def __init__(self, urdf: Path, tip: str, joints: Sequence[str]) -> None:
        """Raises `WrongInputError` when `tip` is no link or a joint does not lead to it."""
        self.joints = tuple(joints)
        links = _load_links(urdf, urdf.stat().st_mtime_ns)
        if tip not in links:
            raise WrongInputError(f"{urdf.name} has no link '{tip}'")
        offsets, axes, limits = [], [], []
        pending = np.eye(4)
        found = []
        for joint in _joints_to(tip, links):
            pending = pending @ joint.origin
            if joint.name in self.joints:
                offsets.append(pending)
                axes.append(joint.axis)
                limits.append(joint.limits)
                found.append(joint.name)
                pending = np.eye(4)
        if found != list(joints):
            raise WrongInputError(
                f"the joints that lead to '{tip}' in {urdf.name} are {', '.join(found)}; "
                f"expected {', '.join(joints)}"
            )
        self._offsets = np.array(offsets).reshape(-1, 4, 4)
        self._axes = np.array(axes).reshape(-1, 3)
        self._tail = pending
        self.lower: Joints = np.array([low for low, _ in limits])
        self.upper: Joints = np.array([high for _, high in limits])
        self._compile()

    def _compile(self) -> None:
        """Compile what a plan calls: amid a run that would stop the robot for seconds."""
        middle = (self.lower + self.upper) / 2
        self.solve(self.pose(middle), middle, middle, iterations=1)

    def pose(self, joints: Joints) -> Matrix4:
        """The tip's pose in the root's frame."""
        pose, _ = _pose_and_jacobian(self._offsets, self._axes, self._tail, joints)
        return np.asarray(pose)

    def jacobian(self, joints: Joints) -> NDArray[np.float64]:
        """The geometric Jacobian (6, n) at the tip: linear rows in m/rad over angular rows."""
        _, jacobian = _pose_and_jacobian(self._offsets, self._axes, self._tail, joints)
        return np.asarray(jacobian)

    def solve(
        self,
        target: Matrix4,
        seed: Joints,
        preferred: Joints,
        preference: float = 0.02,
        iterations: int = 60,
    ) -> Joints | None:
        """Joint angles that put the tip at `target`, found from `seed`; None when not found.

        What the task leaves free is drawn towards `preferred` by `preference` per iteration.
        Damped least squares with a null-space term (Wampler 1986).
        """
        solution, found = _solve(
            self._offsets,
            self._axes,
            self._tail,
            self.lower,
            self.upper,
            np.ascontiguousarray(target, dtype=np.float64),
            np.ascontiguousarray(seed, dtype=np.float64),
            preferred,
            preference,
            iterations,
        )
        return np.asarray(solution) if found else None


@dataclass(frozen=True, slots=True)
class _UrdfJoint:
    name: str
    parent: str
    origin: Matrix4
    axis: NDArray[np.float64]
    limits: tuple[float, float]


@lru_cache(maxsize=4)
def _load_links(urdf: Path, _changed_ns: int) -> Mapping[str, _UrdfJoint | None]:
    """Every link's name with the joint above it; None for the root.

    A robot has many chains, and a whole robot is read in a hundredth of a second.
    """
    robot = ElementTree.parse(urdf).getroot()
    links: dict[str, _UrdfJoint | None] = {
        link.get("name", ""): None for link in robot.findall("link")
    }
    for element in robot.findall("joint"):
        child = element.find("child")
        parent = element.find("parent")
        if child is not None and parent is not None:
            links[child.get("link", "")] = _read_joint(element, parent.get("link", ""))
    return links


def _read_joint(element: ElementTree.Element, parent: str) -> _UrdfJoint:
    origin = np.eye(4)
    placed = element.find("origin")
    if placed is not None:
        origin[:3, :3] = rotation_from_rpy(*_numbers(placed, "rpy"))
        origin[:3, 3] = _numbers(placed, "xyz")
    axis = element.find("axis")
    limit = element.find("limit")
    if limit is not None and limit.get("lower") is not None:
        limits = (float(limit.get("lower", "0")), float(limit.get("upper", "0")))
    else:
        limits = (-_CONTINUOUS_LIMIT_RAD, _CONTINUOUS_LIMIT_RAD)
    return _UrdfJoint(
        name=element.get("name", ""),
        parent=parent,
        origin=origin,
        axis=np.array([1.0, 0.0, 0.0] if axis is None else _numbers(axis, "xyz")),
        limits=limits,
    )


def _numbers(element: ElementTree.Element, attribute: str) -> list[float]:
    return [float(part) for part in element.get(attribute, "0 0 0").split()]


def _joints_to(tip: str, links: Mapping[str, _UrdfJoint | None]) -> list[_UrdfJoint]:
    path = []
    joint = links[tip]
    while joint is not None:
        path.append(joint)
        joint = links[joint.parent]
    return path[::-1]


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
    """The rotation by roll, pitch and yaw about the fixed x, y and z axes (URDF convention)."""
    cr, sr = math.cos(roll), math.sin(roll)
    cp, sp = math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def _kernel(function: Callable[..., Any]) -> Any:
    """Compile it; kernels call each other, and take whatever types they are given."""
    return compiled(function)


@_kernel
def _turn(pose, axis, angle):  # type: ignore[no-untyped-def]
    """Rotate a pose about an axis of its own frame, in place (Rodrigues)."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = axis
    v = 1.0 - c
    rotation = np.array(
        [
            [c + x * x * v, x * y * v - z * s, x * z * v + y * s],
            [x * y * v + z * s, c + y * y * v, y * z * v - x * s],
            [x * z * v - y * s, y * z * v + x * s, c + z * z * v],
        ]
    )
    turned = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                turned[i, j] += pose[i, k] * rotation[k, j]
    pose[:3, :3] = turned


@_kernel
def _product(a, b):  # type: ignore[no-untyped-def]
    """The product of two homogeneous transforms."""
    result = np.zeros((4, 4))
    for i in range(3):
        for j in range(4):
            for k in range(3):
                result[i, j] += a[i, k] * b[k, j]
        result[i, 3] += a[i, 3]
    result[3, 3] = 1.0
    return result


@_kernel
def _pose_and_jacobian(offsets, axes, tail, joints):  # type: ignore[no-untyped-def]
    count = len(joints)
    pose = np.eye(4)
    points = np.empty((count, 3))
    directions = np.zeros((count, 3))
    for i in range(count):
        pose = _product(pose, offsets[i])
        points[i] = pose[:3, 3]
        for row in range(3):
            for k in range(3):
                directions[i, row] += pose[row, k] * axes[i, k]
        _turn(pose, axes[i], joints[i])
    pose = _product(pose, tail)
    jacobian = np.empty((6, count))
    for i in range(count):
        arm = pose[:3, 3] - points[i]
        x, y, z = directions[i]
        jacobian[0, i] = y * arm[2] - z * arm[1]
        jacobian[1, i] = z * arm[0] - x * arm[2]
        jacobian[2, i] = x * arm[1] - y * arm[0]
        jacobian[3:, i] = directions[i]
    return pose, jacobian


@_kernel
def _rotation_vector(target, current):  # type: ignore[no-untyped-def]
    """The rotation vector that turns `current` into `target`, in the root's frame."""
    r = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                r[i, j] += target[i, k] * current[j, k]
    cosine = max(-1.0, min(1.0, (r[0, 0] + r[1, 1] + r[2, 2] - 1.0) / 2.0))
    angle = math.acos(cosine)
    vector = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    if angle < 1e-6:
        return vector / 2.0
    if math.pi - angle < 1e-3:
        # The sine vanishes; the axis is the largest column of (r + 1), whose columns are all
        # along it.
        largest = 0
        for i in range(3):
            if r[i, i] > r[largest, largest]:
                largest = i
        axis = r[:, largest].copy()
        axis[largest] += 1.0
        return axis * (angle / math.sqrt(np.sum(axis * axis)))
    return vector * (angle / (2.0 * math.sin(angle)))


@_kernel
def _solve(  # type: ignore[no-untyped-def]
    offsets, axes, tail, lower, upper, target, seed, preferred, preference, iterations
):
    count = len(seed)
    joints = np.minimum(np.maximum(seed, lower), upper)
    error = np.empty(6)
    for iteration in range(iterations):
        pose, jacobian = _pose_and_jacobian(offsets, axes, tail, joints)
        error[:3] = target[:3, 3] - pose[:3, 3]
        error[3:] = _rotation_vector(target, pose)
        if (
            math.sqrt(np.sum(error[:3] ** 2)) < _POSITION_TOLERANCE_M
            and math.sqrt(np.sum(error[3:] ** 2)) < _ROTATION_TOLERANCE_RAD
        ):
            return joints, True
        damped = jacobian @ jacobian.T + _DAMPING * np.eye(6)
        inverse = np.ascontiguousarray(np.linalg.solve(damped, jacobian).T)
        step = inverse @ error
        # Damping lets the preference leak into the task, so that it has to fade for an exact end.
        pull = preference * (1.0 - iteration / iterations) ** 2
        step += pull * ((np.eye(count) - inverse @ jacobian) @ (preferred - joints))
        largest = np.max(np.abs(step))
        if largest > _MAX_STEP_RAD:
            step *= _MAX_STEP_RAD / largest
        joints = np.minimum(np.maximum(joints + step, lower), upper)
    return joints, False
