"""The body of the robot in a tabletop world: a floating gripper and two cameras."""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.body import ArmPath, ArmRoom, Leg, NoWay, Reach, ToolPose
from mend.robots.arm.gripper import GripperModel
from mend.robots.body import Camera, Matrix4
from mend.robots.vision.seen_box import SeenBox
from mend.sim.base_frame import tool_in_base, tool_in_scene
from mend.sim.tabletop.arm import GRIPPER, StraightPath
from mend.sim.tabletop.gripper_shape import finger_hulls
from mend.sim.tabletop.manipulator import Manipulator
from mend.sim.tabletop.state import CONTROL_PERIOD_S, TabletopState
from mend.tasks.scene import Table

_HIGHEST_M = 1.2
"""How far above the table the tool can go."""


class StraightPlanner:
    """Plans of a gripper that floats: it has no arm that could touch anything."""

    def __init__(self, reach: Reach, table: Table) -> None:
        self._reach = reach
        self._table = table

    @property
    def gripper(self) -> GripperModel:
        return GRIPPER

    def plan(self, waypoints: Sequence[ToolPose]) -> StraightPath | None:
        """Straight lines through the waypoints; None if one is out of reach or in the table."""
        if all(can_reach(self._reach, self._table, each) for each in waypoints):
            return StraightPath(tuple(waypoints))
        return None

    def plan_among(
        self,
        legs: Sequence[Leg],
        boxes: Sequence[SeenBox],  # noqa: ARG002
    ) -> StraightPath | NoWay:
        """As `plan`, whatever stands there."""
        path = self.plan([leg.to for leg in legs])
        return path or NoWay("does not reach all of the way")


class TabletopBody:
    """What behaviors, monitors and looks may ask of a robot, all of it in its base frame."""

    def __init__(
        self,
        state: TabletopState,
        manipulator: Manipulator,
        cameras: Mapping[str, Camera],
        reach: Reach,
    ) -> None:
        self._state = state
        self._manipulator = manipulator
        self._cameras = MappingProxyType(dict(cameras))
        self._reach = reach
        self._planner = StraightPlanner(reach, manipulator.frame.table_to_robot(state.scene.table))

    @property
    def control_period_s(self) -> float:
        return CONTROL_PERIOD_S

    @property
    def cameras(self) -> Mapping[str, Camera]:
        return self._cameras

    @property
    def reach(self) -> Reach:
        return self._reach

    @property
    def room(self) -> ArmRoom:
        return self._manipulator.home.room

    def time_s(self) -> float:
        return self._state.time_s

    def advance_cycle(self) -> None:
        self._state.advance_cycle()

    def plan_path(self, waypoints: Sequence[ToolPose]) -> StraightPath | None:
        """Straight lines through the waypoints; None if one is out of reach or in the table."""
        return self._planner.plan(waypoints)

    def plan_back(self, waypoints: Sequence[ToolPose]) -> StraightPath | None:
        """As `plan_path`: a gripper that floats has no posture."""
        return self._planner.plan(waypoints)

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> StraightPath | NoWay:
        """As `plan_path`: a gripper that floats has no arm that could touch anything."""
        return self._planner.plan_among(legs, boxes)

    def plan_neutral(self) -> StraightPath:
        return StraightPath((self._manipulator.home.neutral,), homeward=True)

    def plan_hand_over(self) -> StraightPath:
        return StraightPath((self._manipulator.home.hand_over,))

    def follow(self, path: ArmPath, segment: int, speed: float) -> None:
        """Raises `TypeError` for a path that this body did not plan."""
        if not isinstance(path, StraightPath):
            raise TypeError(f"expected a path planned by this body, got {type(path).__name__}")
        frame = self._manipulator.frame
        in_scene = tuple(tool_in_scene(frame, each) for each in path.waypoints)
        self._manipulator.arm.follow(StraightPath(in_scene, path.homeward), segment, speed)

    def set_speed(self, speed: float) -> None:
        self._manipulator.arm.speed = speed

    def stop(self) -> None:
        self._manipulator.arm.stop()

    @property
    def gripper(self) -> GripperModel:
        return GRIPPER

    def open_gripper(self, opening_m: float | None = None) -> None:
        self._manipulator.gripper.open(GRIPPER.max_opening_m if opening_m is None else opening_m)

    def close_gripper(self) -> None:
        self._manipulator.gripper.close()

    @property
    def moving(self) -> bool:
        return self._manipulator.arm.moving or self._manipulator.gripper.moving

    @property
    def progress(self) -> float:
        arm, gripper = self._manipulator.arm, self._manipulator.gripper
        return arm.progress if arm.moving else gripper.progress

    def tool_pose(self) -> Matrix4:
        tool = tool_in_base(self._manipulator.frame, self._manipulator.arm.pose)
        cos, sin = math.cos(tool.yaw), math.sin(tool.yaw)
        return np.array(
            [
                [0.0, cos, sin, tool.x],
                [0.0, sin, -cos, tool.y],
                [-1.0, 0.0, 0.0, tool.z],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )

    def gripper_opening_m(self) -> float:
        return self._manipulator.gripper.opening_m

    def gripper_effort_n(self) -> float:
        return GRIPPER.grip_force_n if self._manipulator.held is not None else 0.0

    def finger_hulls(self) -> Sequence[NDArray[np.float64]]:
        return finger_hulls(self._manipulator.gripper.opening_m)

    def contact_force(self) -> NDArray[np.float64]:
        return self._manipulator.contact_force()

    def contact_force_n(self) -> float:
        return float(np.linalg.norm(self.contact_force()))


def can_reach(reach: Reach, table: Table, pose: ToolPose) -> bool:
    """Whether the tool gets there: within reach, and neither in the table nor too high over it."""
    distance_m = math.dist(reach.origin, (pose.x, pose.y))
    height_m = pose.z - table.height
    return reach.min_m <= distance_m <= reach.max_m and 0.0 <= height_m <= _HIGHEST_M
