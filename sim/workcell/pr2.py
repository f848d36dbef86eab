"""The PR2 in the physics engine: joints, motors, finger coupling and what its sensors feel."""

import math
from collections.abc import Sequence

import numpy as np

from mend.robots.arm.motion.collision import CollisionModel
from mend.robots.arm.motion.kinematics import Joints, KinematicChain
from mend.robots.body import Matrix4
from mend.sim.base_frame import base_in_scene
from mend.sim.workcell.arm_dynamics import LinkInertia, Pr2ArmDynamics
from mend.sim.workcell.finger_hulls import Hull, pr2_finger_hulls
from mend.sim.workcell.gripper import FINGERS_OPEN_RAD, inner_side_m
from mend.sim.workcell.physics import Client, Point, to_matrix, yaw_quaternion
from mend.sim.workcell.quiet import silenced
from mend.sim.workcell.robot_model import (
    ARM_JOINTS,
    FINGER_JOINTS,
    FOREARM_CAMERA_FRAME,
    NEUTRAL_RAD,
    TOOL_FRAME,
    robot_urdf,
)
from mend.tasks.frames import Frame

_FOREARM_JOINTS = ARM_JOINTS[:5]

_ARM_TORQUE_NM = 150.0
_BRAKE_TORQUE_NM = 2000.0
"""Stops the arm from full speed in one control cycle."""

_ARM_POSITION_GAIN = 0.3
_ARM_VELOCITY_GAIN = 1.0
JOINT_DAMPING_NM_S = 0.1

# The engine ignores the mimic joints that make real fingers move alike. A stiffness between the
# two finger angles does it instead; stiffer or stronger than this, a part slides away sideways.
_GRIP_TORQUE_NM = 3.0
_FINGER_COUPLING_NM_RAD = 60.0
_FINGER_DAMPING_NM_S_RAD = 0.2
"""The stiffness acts a cycle late: without damping a heavy part swings between the fingers."""
_LEAST_GRIP_TORQUE_NM = 0.3
_TIP_TORQUE_NM = 100.0
_FINGER_GAINS = (0.1, 0.1, 0.5, 0.5)
_FINGER_FRICTION = 1.2
_FINGER_SPIN_FRICTION = 0.02
_TURNED_RAD = 0.1
"""The fingers' contacts are found anew each time that the gripper has turned so far."""

_WRIST_TO_TOOL_M = 0.18
_FINGER_LENGTH_M = 0.0914
"""From a finger's joint to where it presses."""

_MARGIN_M = 0.001
"""So far in front of each drawn pad is the one that touches what the fingers close on."""

_ARM_COLOR = (0.80, 0.80, 0.82, 1.0)
_GRIPPER_COLOR = (0.35, 0.36, 0.38, 1.0)


class Pr2:
    """A PR2 whose right arm and gripper move; everything else of it is fixed.

    All poses are in its base frame, which `base` has in the scene's.
    """

    def __init__(self, client: Client, frame: Frame) -> None:
        self._client = client
        self.base = base_in_scene(frame)
        urdf = self._urdf = robot_urdf()
        with silenced():
            self.body_id: int = client.loadURDF(
                str(urdf),
                [frame.x, frame.y, 0.0],
                yaw_quaternion(frame.yaw),
                useFixedBase=True,
                flags=client.URDF_MERGE_FIXED_LINKS,
            )
        link_of = self._links_by_joint()
        self._arm = [link_of[name] for name in ARM_JOINTS]
        self._fingers = [link_of[name] for name in FINGER_JOINTS]
        self._sides = (
            {self._fingers[0], self._fingers[2]},
            {self._fingers[1], self._fingers[3]},
        )
        self.tool = KinematicChain(urdf, TOOL_FRAME, ARM_JOINTS)
        self.collisions = CollisionModel(urdf, ARM_JOINTS, TOOL_FRAME)
        self._forearm_camera = KinematicChain(urdf, FOREARM_CAMERA_FRAME, _FOREARM_JOINTS)
        self._hulls = pr2_finger_hulls(urdf)
        self._set_up_dynamics(link_of)
        self._paint(link_of)
        self.place_arm(np.array(NEUTRAL_RAD))

    def place_arm(self, joints: Joints) -> None:
        """Put the arm somewhere at once, at rest and with the gripper open."""
        for link, angle in zip(self._arm, joints, strict=True):
            self._client.resetJointState(self.body_id, link, angle)
        for link in self._fingers:
            self._client.resetJointState(self.body_id, link, FINGERS_OPEN_RAD)
        self.sense()
        self._contacts_at = self._gripper_axes()

    def sense(self) -> None:
        """Read the joints' sensors: what they tell holds until the next physics step."""
        states = self._client.getJointStates(self.body_id, [*self._arm, *self._fingers])
        angles, velocities, _, torques = zip(*states, strict=True)
        arm = len(self._arm)
        self._arm_angles: Joints = np.array(angles[:arm])
        self._arm_velocities: Joints = np.array(velocities[:arm])
        self._arm_torques_nm: Joints = np.array(torques[:arm])
        self._finger_angles: tuple[float, ...] = angles[arm:]
        self._finger_velocities: tuple[float, ...] = velocities[arm:]
        self._finger_torques_nm: tuple[float, ...] = torques[arm:]

    def drive(
        self, joints: Joints, velocities: Joints, fingers_rad: float, brake: bool = False
    ) -> None:
        """Set every motor's target for the next physics step; `brake` helps the motors stop."""
        client = self._client
        client.setJointMotorControlArray(
            self.body_id,
            self._arm,
            client.POSITION_CONTROL,
            joints.tolist(),
            velocities.tolist(),
            [_BRAKE_TORQUE_NM if brake else _ARM_TORQUE_NM] * len(self._arm),
            [_ARM_POSITION_GAIN] * len(self._arm),
            [_ARM_VELOCITY_GAIN] * len(self._arm),
        )
        left, right = self.finger_angles()
        pull = _FINGER_COUPLING_NM_RAD * (left - right)
        pull += _FINGER_DAMPING_NM_S_RAD * (self._finger_velocities[0] - self._finger_velocities[1])
        client.setJointMotorControlArray(
            self.body_id,
            self._fingers,
            client.POSITION_CONTROL,
            [fingers_rad, fingers_rad, left, right],
            forces=[
                max(_LEAST_GRIP_TORQUE_NM, _GRIP_TORQUE_NM + pull),
                max(_LEAST_GRIP_TORQUE_NM, _GRIP_TORQUE_NM - pull),
                _TIP_TORQUE_NM,
                _TIP_TORQUE_NM,
            ],
            positionGains=_FINGER_GAINS,
        )

    def renew_contacts(self) -> None:
        """Have the engine find anew how the fingers touch things, if the gripper has turned.

        As long as bodies touch it keeps the directions in which they press in the base frame:
        fingers that turn with what they hold would press askew, and it would creep in them.
        """
        axes = self._gripper_axes()
        if np.sum(axes * self._contacts_at) > 1.0 + 2.0 * math.cos(_TURNED_RAD):
            return
        self._contacts_at = axes
        for body_id in self.touched() - {self.body_id}:
            for link in self._fingers:
                for enabled in (0, 1):
                    self._client.setCollisionFilterPair(
                        self.body_id, body_id, link, -1, enableCollision=enabled
                    )

    def _gripper_axes(self) -> Matrix4:
        """The gripper's axes in the base frame, as columns (3, 3)."""
        return self.tool.pose(self._arm_angles)[:3, :3]

    def arm_joints(self) -> Joints:
        """The measured joint angles of the arm."""
        return self._arm_angles.copy()

    def joint_positions(self) -> list[float]:
        """The measured angles of the arm's joints, then of the fingers'."""
        return [*self._arm_angles.tolist(), *self._finger_angles]

    def forearm_camera_pose(self) -> Matrix4:
        """The forearm camera's optical frame, from the measured joint angles."""
        return self._forearm_camera.pose(self.arm_joints()[: len(_FOREARM_JOINTS)])

    def tool_in_scene(self) -> Matrix4:
        """The tool point's pose in the scene's frame, from the measured joint angles."""
        return np.asarray(self.base @ self.tool.pose(self._arm_angles))

    def wrist(self, tool: Matrix4) -> Point:
        """Where the wrist is behind a tool pose, in the same frame."""
        x, y, z = (float(each) for each in tool[:3, 3] - _WRIST_TO_TOOL_M * tool[:3, 0])
        return x, y, z

    def finger_angles(self) -> tuple[float, float]:
        """The measured angles of the left and the right finger."""
        left, right, *_ = self._finger_angles
        return left, right

    def gripper_opening_m(self) -> float:
        """The distance between the pads, which stay parallel; negative where they press together.

        It is calibrated as on a gauge: it is the width of what the fingers have closed on.
        """
        return sum(inner_side_m(angle) - _MARGIN_M for angle in self.finger_angles())

    def gripper_effort_n(self) -> float:
        """The force with which the fingers press together, by their motors' torques."""
        closing_nm = -sum(self._finger_torques_nm[:2]) / 2
        return max(0.0, closing_nm / _FINGER_LENGTH_M)

    def finger_hulls(self) -> Sequence[Hull]:
        """The gripper's convex pieces in the tool frame, by the measured finger angles."""
        return self._hulls.at(dict(zip(FINGER_JOINTS, self._finger_angles, strict=True)))

    def touched_by(self, body_id: int) -> tuple[bool, bool]:
        """Whether the left and the right finger touch a body."""
        touching = {contact[3] for contact in self._client.getContactPoints(self.body_id, body_id)}
        left, right = self._sides
        return bool(touching & left), bool(touching & right)

    def touched(self) -> set[int]:
        """The bodies that a finger touches."""
        left, right = self._sides
        contacts = self._client.getContactPoints(self.body_id)
        return {contact[2] for contact in contacts if contact[3] in left | right}

    def arm_motion(self) -> tuple[Joints, Joints, Joints]:
        """The arm joints' angles (rad), velocities (rad/s) and motor torques (N m)."""
        return self.arm_joints(), self._arm_velocities.copy(), self._arm_torques_nm.copy()

    def dynamics(self) -> Pr2ArmDynamics:
        """The arm as a rigid-body model, with its links as the engine weighs them."""
        links = zip((*ARM_JOINTS, *FINGER_JOINTS), (*self._arm, *self._fingers), strict=True)
        return Pr2ArmDynamics(self._urdf, {name: self._inertia(link) for name, link in links})

    def _inertia(self, link: int) -> LinkInertia:
        info = self._client.getDynamicsInfo(self.body_id, link)
        frame = to_matrix(info[3], info[4])
        turn = frame[:3, :3]
        return LinkInertia(info[0], frame[:3, 3], turn @ np.diag(info[2]) @ turn.T)

    def _links_by_joint(self) -> dict[str, int]:
        count = self._client.getNumJoints(self.body_id)
        infos = (self._client.getJointInfo(self.body_id, index) for index in range(count))
        return {info[1].decode(): info[0] for info in infos}

    def _set_up_dynamics(self, link_of: dict[str, int]) -> None:
        for name, link in link_of.items():
            self._client.changeDynamics(
                self.body_id,
                link,
                linearDamping=0,
                angularDamping=0,
                jointDamping=JOINT_DAMPING_NM_S,
            )
            if name in FINGER_JOINTS:
                self._client.changeDynamics(
                    self.body_id,
                    link,
                    lateralFriction=_FINGER_FRICTION,
                    spinningFriction=_FINGER_SPIN_FRICTION,
                    rollingFriction=0,
                )

    def _paint(self, link_of: dict[str, int]) -> None:
        """Grey all over: the description's debug colours are those of parts."""
        for name, link in (("base", -1), *link_of.items()):
            color = _GRIPPER_COLOR if "gripper" in name else _ARM_COLOR
            self._client.changeVisualShape(self.body_id, link, rgbaColor=color)
