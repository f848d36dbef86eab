"""The parts of a scene in the physics engine: boxes, and plates with a knob."""

import math
from dataclasses import dataclass

import numpy as np

from mend.sim.workcell.physics import Client, Point, Quaternion, to_matrix, wake, yaw_quaternion
from mend.tasks.scene import Pose, SceneObject

_FRICTION = 0.8
_SPIN_FRICTION = 0.01

_LEAST_MASS_KG = 0.03
_LEAST_INERTIA_KG_M2 = 5e-5
"""Parts move as if they had at least this mass, and this moment of inertia, that of a 120 g cube of
50 mm: the engine's solver does not converge for less between fingers that are far heavier, which
then sink into the part and lose it (every pick of 3 g), or leave it up to 3.6 mm off (10 g)."""

_AWAY_X_M = -3.0
_AWAY_SPACING_M = 0.5
"""What is taken away waits behind the robot, where no camera looks."""

_AT_REST = 0.01
"""Slower than this (m/s and rad/s) a part is at rest."""
_ASLEEP_BELOW = _AT_REST**2
"""The sum of both speeds squared below which, for two seconds, the engine lets a part sleep."""


@dataclass(frozen=True, slots=True)
class PartPose:
    """Where the bottom centre of a part is, and how it is turned, in the base frame."""

    position: Point
    quaternion: Quaternion

    @property
    def yaw(self) -> float:
        """The turn about the vertical of the part's x axis."""
        x_axis = to_matrix(self.position, self.quaternion)[:3, 0]
        return math.atan2(x_axis[1], x_axis[0])

    @property
    def tilt_rad(self) -> float:
        """How far the part's z axis leans away from the vertical."""
        z_axis = to_matrix(self.position, self.quaternion)[:3, 2]
        return math.acos(min(1.0, float(z_axis[2])))

    @classmethod
    def upright(cls, x: float, y: float, z: float, yaw: float) -> "PartPose":
        return cls((x, y, z), yaw_quaternion(yaw))

    @classmethod
    def at(cls, pose: Pose, table_height_m: float) -> "PartPose":
        """Where a scene says; without a height, on the table."""
        z = table_height_m if pose.z is None else pose.z
        return cls.upright(pose.x, pose.y, z, pose.yaw)


class RigidPart:
    """One part: a rigid body that can be put somewhere or taken away."""

    def __init__(self, client: Client, name: str, definition: SceneObject, number: int) -> None:
        self._client = client
        self.name = name
        self.definition = definition
        self.body_id = _create_body(client, definition)
        self._away = PartPose.upright(_AWAY_X_M, number * _AWAY_SPACING_M, 0.0, 0.0)
        self.stolen = False
        self.hidden = False
        """Whether it is in a hand that nobody can see."""
        self.start = self._away
        self.last_rest = self._away
        """Where it rested last, for a world that is rebuilt while it is in the air."""
        self._rested: tuple[Point, Quaternion] | None = None
        """The same as the engine has it."""

    @property
    def _middle_m(self) -> float:
        """How far the body's frame is above the bottom."""
        return self.definition.size[2] / 2

    def pose(self) -> PartPose:
        position, quaternion = self._client.getBasePositionAndOrientation(self.body_id)
        up = to_matrix(position, quaternion)[:3, 2] * self._middle_m
        x, y, z = (float(value) for value in np.array(position) - up)
        return PartPose((x, y, z), quaternion)

    def put(self, pose: PartPose) -> None:
        """Be at a pose at once, at rest."""
        self.stolen = False
        self._reset(pose)

    def take_away(self) -> None:
        """Be gone until somebody brings it back."""
        self.stolen = True
        self._reset(self._away)

    def hide(self) -> None:
        """Be in somebody's hand, out of the cameras' sight and the arm's reach."""
        self._reset(self._away)
        self.hidden = True

    def at_rest(self) -> bool:
        linear, angular = self._client.getBaseVelocity(self.body_id)
        return all(abs(each) < _AT_REST for each in (*linear, *angular))

    def remember_rest(self) -> None:
        """Where it lies still is where it last rested."""
        now = self._client.getBasePositionAndOrientation(self.body_id)
        if now != self._rested and self.at_rest():
            self._rested, self.last_rest = now, self.pose()

    def body_pose(self, pose: PartPose) -> tuple[Point, Quaternion]:
        """The engine's frame of the body when its bottom centre is at `pose`."""
        up = to_matrix(pose.position, pose.quaternion)[:3, 2] * self._middle_m
        x, y, z = (float(value) for value in np.array(pose.position) + up)
        return (x, y, z), pose.quaternion

    def stay_awake(self, wanted: bool) -> None:
        """Whether it is moved by something other than what touches it."""
        client = self._client
        state = "DISABLE_SLEEPING" if wanted else "ENABLE_SLEEPING"
        activation = getattr(client, f"ACTIVATION_STATE_{state}")
        client.changeDynamics(self.body_id, -1, activationState=activation)

    def _reset(self, pose: PartPose) -> None:
        self.hidden = False
        self._wake_what_touches()
        self._client.resetBasePositionAndOrientation(self.body_id, *self.body_pose(pose))
        self._client.resetBaseVelocity(self.body_id, [0.0] * 3, [0.0] * 3)
        wake(self._client, self.body_id)

    def _wake_what_touches(self) -> None:
        """What it leaves may have rested on it."""
        touching = self._client.getContactPoints(bodyA=self.body_id)
        for other in {point[2] for point in touching}:
            wake(self._client, other)


def _create_body(client: Client, definition: SceneObject) -> int:
    halves = [_half(definition.size)]
    centers = [(0.0, 0.0, 0.0)]
    if definition.knob is not None:
        halves.append(_half(definition.knob))
        centers.append((0.0, 0.0, (definition.size[2] + definition.knob[2]) / 2))
    boxes = [client.GEOM_BOX] * len(halves)
    collision = client.createCollisionShapeArray(
        boxes, halfExtents=halves, collisionFramePositions=centers
    )
    visual = client.createVisualShapeArray(
        boxes,
        halfExtents=halves,
        visualFramePositions=centers,
        rgbaColors=[(*definition.color, 1.0)] * len(halves),
    )
    body_id: int = client.createMultiBody(
        max(definition.mass_kg, _LEAST_MASS_KG), collision, visual
    )
    inertia = client.getDynamicsInfo(body_id, -1)[2]
    client.changeDynamics(
        body_id,
        -1,
        localInertiaDiagonal=[max(each, _LEAST_INERTIA_KG_M2) for each in inertia],
        lateralFriction=_FRICTION,
        spinningFriction=_SPIN_FRICTION,
        rollingFriction=0,
        # Without an anchor, friction holds velocities only: what is grasped creeps sideways.
        frictionAnchor=1,
        # What has come to rest costs nothing until something awake touches it.
        activationState=client.ACTIVATION_STATE_ENABLE_SLEEPING,
        sleepThreshold=_ASLEEP_BELOW,
    )
    return body_id


def _half(size: tuple[float, float, float]) -> Point:
    return size[0] / 2, size[1] / 2, size[2] / 2
