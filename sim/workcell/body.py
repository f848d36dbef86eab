"""The PR2 as a `mend.robots.body.Body`: motions of the arm and the gripper, cameras, sensing."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.body import ArmPath, ArmRoom, Leg, NoWay, Reach, ToolPose
from mend.robots.arm.gripper import GripperModel
from mend.robots.arm.motion.curve import JointCurve
from mend.robots.arm.motion.kinematics import Joints
from mend.robots.arm.motion.limits import MotionLimits
from mend.robots.arm.motion.planner import JointPath, PathPlanner, PathSegment
from mend.robots.arm.motion.timing import TimedMotion
from mend.robots.body import Camera, Matrix4
from mend.robots.vision.seen_box import SeenBox
from mend.sim.workcell.arm_planner import plan_legs
from mend.sim.workcell.clock import PERIOD_S, Clock
from mend.sim.workcell.effort_sensors import ENCODER_NOISE_M, FINGER_NOISE_N
from mend.sim.workcell.finger_hulls import Hull
from mend.sim.workcell.finger_motion import FingerMotion
from mend.sim.workcell.gripper import PR2_GRIPPER, finger_angle_rad
from mend.sim.workcell.pr2 import JOINT_DAMPING_NM_S, Pr2
from mend.sim.workcell.reach import ARM_ROOM, HAND_OVER_POSE, pr2_reach
from mend.sim.workcell.robot_model import (
    ARM_JOINTS,
    FINGER_JOINTS,
    MODEL,
    NEUTRAL_RAD,
    PREFERRED_RAD,
)
from mend.sim.workcell.touch import Touch

LIMITS = MotionLimits(
    velocity_rad_s=1.6,
    acceleration_rad_s2=5.0,
    jerk_rad_s3=40.0,
    tool_velocity_m_s=0.35,
)

_SETTLE_CYCLES = 24
"""The arm lags behind its target by some cycles; this long after it, it is at rest."""

_MOST_LAG_RAD = 0.06
"""A motion waits for an arm that lags further behind, so that it never pushes harder than this
makes it, nor jumps when what held it up gives way."""

_GIVE_UP_CYCLES = 240
"""An arm that was held up for so long stays where it is."""


class WorkcellBody:
    """The right arm, gripper and cameras of a simulated PR2.

    It knows its own joint angles and what its joints feel, and nothing else of the world. All
    poses are in its base frame.
    """

    cameras: Mapping[str, Camera]

    def __init__(
        self,
        pr2: Pr2,
        rng: np.random.Generator,
        sensor_rng: np.random.Generator,
        clock: Clock,
        advance_world: Callable[[], None],
    ) -> None:
        """`advance_world` lets one control cycle pass for everything, this body included."""
        self.pr2 = pr2
        self._sensor_rng = sensor_rng
        self._touch = Touch(pr2.dynamics(), JOINT_DAMPING_NM_S, PERIOD_S, sensor_rng)
        self._rng = rng
        self._clock = clock
        self._advance_world = advance_world
        self._planner = PathPlanner(pr2.tool, np.array(PREFERRED_RAD))
        self._target: Joints = np.array(NEUTRAL_RAD)
        self._motion: TimedMotion | None = None
        self._way_ahead: Sequence[PathSegment] = ()
        self._to_hand_over: ArmPath | None = None
        self._stretched_out = False
        self._settling_cycles = 0
        self._held_up_cycles = 0
        self._braking = False
        self._gripper = FingerMotion()

    @property
    def model(self) -> str:
        return MODEL

    @property
    def joint_names(self) -> Sequence[str]:
        """The arm's joints, then the fingers'."""
        return (*ARM_JOINTS, *FINGER_JOINTS)

    def joint_positions(self) -> Sequence[float]:
        return self.pr2.joint_positions()

    @property
    def control_period_s(self) -> float:
        return PERIOD_S

    @property
    def reach(self) -> Reach:
        return pr2_reach()

    @property
    def room(self) -> ArmRoom:
        return ARM_ROOM

    def time_s(self) -> float:
        return self._clock.time_s()

    def advance_cycle(self) -> None:
        self._advance_world()

    def begin_cycle(self) -> None:
        """Command the motors: what comes before the physics step that is everybody's."""
        velocities = self._advance_arm()
        self._gripper.advance()
        self.pr2.drive(self._target, velocities, self._gripper.target_rad, self._braking)
        self._braking = False
        if self.gripper_in_use:
            self.pr2.renew_contacts()

    def end_cycle(self) -> None:
        """Feel what has come of it: what comes after the physics step."""
        self.pr2.sense()
        self._touch.feel(*self.pr2.arm_motion())

    def go_neutral_at_once(self) -> None:
        """Be at neutral, at rest and with the gripper open (a rebuilt world)."""
        self._motion = None
        self._stretched_out = False
        self._target = np.array(NEUTRAL_RAD)
        self._gripper = FingerMotion()
        self.pr2.place_arm(self._target)
        self._touch.reset()

    def plan_path(self, waypoints: Sequence[ToolPose]) -> ArmPath | None:
        """Plan through all waypoints; each at its yaw, or each at its yaw + pi."""
        return _path(self._planner.plan(self._target, waypoints, self._rng))

    def plan_back(self, waypoints: Sequence[ToolPose]) -> ArmPath | None:
        """Back through poses that the tool has just passed, in the posture that the arm has."""
        return self._planner.plan_back(self._target, waypoints)

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> ArmPath | NoWay:
        """Plan through all legs so that nothing touches any of `boxes`."""
        return plan_legs(self._planner, self.pr2.collisions, self._target, legs, boxes, self._rng)

    def plan_neutral(self) -> ArmPath:
        return self._planner.plan_to_joints(self._target, np.array(NEUTRAL_RAD))

    def plan_hand_over(self) -> ArmPath:
        path = _path(self._planner.plan(self._target, [HAND_OVER_POSE], self._rng))
        self._to_hand_over = path if path is not None else self.plan_neutral()
        return self._to_hand_over

    def follow(self, path: ArmPath, segment: int, speed: float) -> None:
        """Start one segment from wherever the arm is.

        Raises `TypeError` for a path of another body, `ValueError` for a speed outside (0, 1].
        """
        if not isinstance(path, JointPath):
            raise TypeError(f"this arm follows paths that it planned itself, not {type(path)}")
        self._stretched_out = path is self._to_hand_over
        way = path.ways[segment]
        curve = way.curve.joined_from(self._target)
        self._motion = TimedMotion(curve, LIMITS, PERIOD_S, speed, way.straight)
        self._settling_cycles = _SETTLE_CYCLES
        self._held_up_cycles = 0
        self._way_ahead = path.ways[segment + 1 :]

    def set_speed(self, speed: float) -> None:
        """Raises `ValueError` for a speed outside (0, 1]."""
        if self._motion is not None:
            self._motion.set_speed(speed)

    def stop(self) -> None:
        self._braking = self._motion is not None
        self._motion = None
        self._target = self.pr2.arm_joints()
        self._gripper.stop()

    @property
    def gripper(self) -> GripperModel:
        return PR2_GRIPPER

    def open_gripper(self, opening_m: float | None = None) -> None:
        wanted_m = PR2_GRIPPER.max_opening_m if opening_m is None else opening_m
        self._gripper.open_to(finger_angle_rad(wanted_m))

    def close_gripper(self) -> None:
        self._gripper.close()

    @property
    def moving(self) -> bool:
        return self._motion is not None or self._gripper.moving

    @property
    def progress(self) -> float:
        if self._motion is not None:
            return self._motion.progress
        return self._gripper.progress

    def tool_pose(self) -> Matrix4:
        return self.pr2.tool.pose(self.pr2.arm_joints())

    def gripper_opening_m(self) -> float:
        noise_m = ENCODER_NOISE_M * float(self._sensor_rng.standard_normal())
        return max(0.0, self.pr2.gripper_opening_m() + noise_m)

    def gripper_effort_n(self) -> float:
        noise_n = FINGER_NOISE_N * float(self._sensor_rng.standard_normal())
        return max(0.0, self.pr2.gripper_effort_n() + noise_n)

    def finger_hulls(self) -> Sequence[Hull]:
        return self.pr2.finger_hulls()

    def contact_force(self) -> NDArray[np.float64]:
        return self._touch.force

    def contact_force_n(self) -> float:
        return float(np.linalg.norm(self.contact_force()))

    @property
    def gripper_closing(self) -> bool:
        """Whether the fingers are closed or on their way together."""
        return self._gripper.closing

    @property
    def gripper_in_use(self) -> bool:
        """Whether the gripper is closed or its fingers move."""
        return self._gripper.closing or self._gripper.moving

    @property
    def ready_to_take(self) -> bool:
        """Whether the arm rests with the gripper open."""
        return not self.moving and not self._gripper.closing

    @property
    def stretched_out(self) -> bool:
        """Whether the arm is, or was last, on its way to take what people hold out."""
        return self._stretched_out

    def ways_ahead(self) -> list[JointCurve]:
        """The rest of the segment under way, the path's segments after it, the way to neutral."""
        ways = []
        if self._motion is not None:
            ways = [self._motion.rest(), *(way.curve for way in self._way_ahead)]
        end = ways[-1].end if ways else self._target
        return [*ways, JointCurve([end, np.array(NEUTRAL_RAD)])]

    def _advance_arm(self) -> Joints:
        """The joint velocities to command in this cycle, with the target moved on."""
        if self._motion is None:
            return np.zeros(len(self._target))
        if self._is_held_up():
            self._held_up_cycles += 1
            if self._held_up_cycles >= _GIVE_UP_CYCLES:
                self.stop()
            return np.zeros(len(self._target))
        self._held_up_cycles = 0
        self._target, velocities = self._motion.advance()
        if self._motion.finished:
            self._settling_cycles -= 1
            if self._settling_cycles <= 0:
                self._motion = None
        return velocities

    def _is_held_up(self) -> bool:
        """Whether something keeps the arm from following its target."""
        lag = np.abs(self._target - self.pr2.arm_joints()).max()
        return bool(lag > _MOST_LAG_RAD)


def _path(planned: JointPath | NoWay) -> JointPath | None:
    return planned if isinstance(planned, JointPath) else None
