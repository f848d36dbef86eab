"""What a person holds in the arm's way, and where it meets the arm but no part."""

from collections.abc import Iterable, Iterator

import numpy as np

from mend.robots.arm.motion.curve import JointCurve
from mend.robots.arm.motion.kinematics import KinematicChain
from mend.robots.body import Matrix4
from mend.robots.link.messages import ShownObject, ShownPose
from mend.sim.workcell.physics import Client, Point

_HALF_M = (0.05, 0.05, 0.05)
_COLOR = (0.25, 0.27, 0.30, 1.0)
_AWAY: Point = (-3.0, -2.0, 1.0)
_UPRIGHT = (0.0, 0.0, 0.0, 1.0)

_MASS_KG = 1.0
_HOLD_FORCE_N = 250.0
"""A person gives way to whatever pushes harder."""

_ABOVE_TOOL_M = 0.045
"""Higher than what hangs between the fingers reaches, low enough to meet the fingers."""

_CLEAR_OF_ARM_M = 0.02
_CLEAR_OF_PARTS_M = 0.035
_SAMPLES = 40

_SINKS_M = 0.06
"""An arm that is about to sink by more than this comes down on what is held just under it."""
_BEHIND_CAMERA = (1.2, 1.35, 1.5)
"""How far from wrist to camera and beyond: what is held there hides nothing from the camera."""
_LOWER_M = 0.01
_LOWEST_M = 0.12


class Obstacle:
    """A box that a person holds in the air, or has taken away."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self.center: Point | None = None
        self._body_id: int = client.createMultiBody(
            _MASS_KG,
            client.createCollisionShape(client.GEOM_BOX, halfExtents=_HALF_M),
            client.createVisualShape(client.GEOM_BOX, halfExtents=_HALF_M, rgbaColor=_COLOR),
            _AWAY,
        )
        self._hold: int = client.createConstraint(
            self._body_id, -1, -1, -1, client.JOINT_FIXED, [0, 0, 0], [0, 0, 0], _AWAY
        )
        self._move_to(_AWAY)

    @property
    def shown(self) -> ShownObject:
        """What it looks like, for people who watch."""
        x, y, z = (2.0 * half for half in _HALF_M)
        return ShownObject(name="obstacle", kind="obstacle", size=(x, y, z), color=_COLOR[:3])

    def shown_pose(self) -> ShownPose:
        """Where its bottom centre is; gone while nobody holds it."""
        position, quaternion = self._client.getBasePositionAndOrientation(self._body_id)
        x, y, z = position[0], position[1], position[2] - _HALF_M[2]
        return ShownPose(pose=(x, y, z, *quaternion), gone=self.center is None)

    def stand_at(self, center: Point) -> None:
        """Be in the air around a point."""
        self.center = center
        self._move_to(center)

    def withdraw(self) -> None:
        """Be out of the way."""
        self.center = None
        self._move_to(_AWAY)

    def _move_to(self, center: Point) -> None:
        client = self._client
        client.resetBasePositionAndOrientation(self._body_id, center, _UPRIGHT)
        client.resetBaseVelocity(self._body_id, [0.0] * 3, [0.0] * 3)
        client.changeConstraint(self._hold, center, maxForce=_HOLD_FORCE_N)

    def is_clear_of(self, arms: Iterable[int], parts: Iterable[int]) -> bool:
        """Whether there is room between it and every arm, and more to every one of some parts."""
        near = self._client.getClosestPoints
        return not any(near(self._body_id, arm, _CLEAR_OF_ARM_M) for arm in arms) and not any(
            near(self._body_id, part, _CLEAR_OF_PARTS_M) for part in parts
        )


def center_above(x: float, y: float, tool_z: float) -> Point:
    """The middle of an obstacle that a tool at this point of its way would run into."""
    return x, y, tool_z + _ABOVE_TOOL_M + _HALF_M[2]


def centers_ahead(
    base: Matrix4, tool: KinematicChain, ways: Iterable[JointCurve]
) -> Iterator[Point]:
    """Where an obstacle would be met on the way, the nearest first; `base` is the arm's frame."""
    for way in ways:
        for parameter in np.linspace(0.0, way.length, _SAMPLES):
            x, y, z = (base @ tool.pose(way.at(float(parameter))))[:3, 3]
            yield center_above(float(x), float(y), float(z))


def sinks(tool: KinematicChain, here: Matrix4, ways: Iterable[JointCurve]) -> bool:
    """Whether the tool is about to go down."""
    return any(tool.pose(way.end)[2, 3] < here[2, 3] - _SINKS_M for way in ways)


def centers_below(wrist: Point, camera: Point) -> Iterator[Point]:
    """Under the forearm, behind its camera as seen from the wrist, the nearest to it first."""
    for share in _BEHIND_CAMERA:
        x, y, z = (float(each) for each in np.array(wrist) * (1 - share) + np.array(camera) * share)
        for below_m in np.arange(0.0, _LOWEST_M, _LOWER_M):
            yield x, y, z - _HALF_M[2] - float(below_m)
