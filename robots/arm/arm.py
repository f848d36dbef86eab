"""An arm and its gripper: moving them, in routines that take many control cycles."""

import math

from mend.robots.arm.body import ArmBody, ArmPath, ToolPose
from mend.robots.execution.effector import Effector
from mend.robots.execution.routine import Routine

_CLEAR_HEIGHTS_M = (0.14, 0.10, 0.06, 0.03)
"""How far the tool point is raised before it leaves sideways: the first that is within reach."""
_RETREAT_SPEED = 0.6
_POINTS_DOWN = -0.97


class Arm(Effector[ArmBody]):
    """An arm and its gripper; it is at rest at neutral."""

    def __init__(self, body: ArmBody) -> None:
        super().__init__(body)
        self._speed = 1.0
        """That of the motion under way, before it is scaled."""
        self._opened_m = 0.0
        """How wide the gripper was last told to open; 0 since it was told to close."""

    def start(self, path: ArmPath, segment: int, speed: float) -> None:
        """Start one segment of a path."""
        self.at_rest = False
        self._speed = speed
        self.body.follow(path, segment, self._scaled(speed))

    def follow(self, path: ArmPath, speed: float) -> Routine[None]:
        """Go through a whole path."""
        for segment in range(path.segments):
            self.start(path, segment, speed)
            yield from self.settle()

    def start_opening(self, opening_m: float | None = None) -> None:
        """Move the fingers to be `opening_m` apart, without one as far as they go."""
        self._opened_m = self._opening(opening_m)
        self.body.open_gripper(opening_m)

    def start_opening_to(self, opening_m: float) -> None:
        """As `start_opening`, unless the fingers were told so already."""
        if self._opened_m != opening_m:
            self.start_opening(opening_m)

    def start_closing(self) -> None:
        self._opened_m = 0.0
        self.body.close_gripper()

    def open_gripper(self, opening_m: float | None = None) -> Routine[None]:
        """Open the gripper as `start_opening`, unless it is open so far."""
        if self._opened_m != self._opening(opening_m):
            self.start_opening(opening_m)
        yield from self.settle()

    def close_gripper(self) -> Routine[None]:
        self.start_closing()
        yield from self.settle()

    def go_to_neutral(self) -> Routine[None]:
        """Leave upwards, then move to where the arm hides nothing from the head camera."""
        if self.at_rest:
            return
        yield from self.lift()
        yield from self.follow(self.body.plan_neutral(), _RETREAT_SPEED)
        self.at_rest = True

    def go_to_hand_over(self) -> Routine[None]:
        """Move to where a person hands something to the robot."""
        yield from self.lift()
        yield from self.follow(self.body.plan_hand_over(), _RETREAT_SPEED)

    def tool_pose(self) -> ToolPose | None:
        """Where the tool point is; None unless the gripper points straight down."""
        tool = self.body.tool_pose()
        if tool[2, 0] > _POINTS_DOWN:
            return None
        yaw = math.atan2(tool[1, 1], tool[0, 1])
        return ToolPose(float(tool[0, 3]), float(tool[1, 3]), float(tool[2, 3]), yaw)

    def lift(self) -> Routine[None]:
        """Raise the tool point straight up before it leaves sideways, where that is possible."""
        pose = None if self.at_rest else self.tool_pose()
        if pose is None:
            return
        for height_m in _CLEAR_HEIGHTS_M:
            up = ToolPose(pose.x, pose.y, pose.z + height_m, pose.yaw)
            path = self.body.plan_path([up])
            if path is not None:
                yield from self.follow(path, _RETREAT_SPEED)
                return

    def _apply_speed(self) -> None:
        if self.body.moving:
            self.body.set_speed(self._scaled(self._speed))

    def _opening(self, opening_m: float | None) -> float:
        return self.body.gripper.max_opening_m if opening_m is None else opening_m
