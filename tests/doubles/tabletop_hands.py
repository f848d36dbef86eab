"""Drives a tabletop world by its body alone, as a behavior would."""

import math

from mend.robots.arm.body import ToolPose
from mend.sim.tabletop.world import TabletopWorld

TABLE_M = 0.70


class Hands:
    """Moves a world's gripper the way a behavior would."""

    def __init__(self, world: TabletopWorld) -> None:
        self.world = world
        self.body = world.body

    def settle(self, cycles: int = 200) -> None:
        for _ in range(cycles):
            if not self.body.moving:
                return
            self.body.advance_cycle()
        raise AssertionError("the arm is still moving")

    def wait(self, duration_s: float) -> None:
        for _ in range(round(duration_s / self.body.control_period_s)):
            self.body.advance_cycle()

    def go(self, x: float, y: float, z: float, yaw: float) -> None:
        path = self.body.plan_path([ToolPose(x, y, z, yaw)])
        assert path is not None
        self.body.follow(path, 0, 1.0)
        self.settle()

    def open(self) -> None:
        self.body.open_gripper()
        self.settle()

    def close(self) -> None:
        self.body.close_gripper()
        self.settle()

    def pick(self, name: str, *, off_m: float = 0.0, turn: float = 0.0) -> None:
        """Grasp a part from above, perhaps off along the opening direction or turned."""
        pose = self.world.pose_of(name)
        part = self.world.scene.objects[name]
        assert pose is not None
        grasped = part.knob or part.size
        bottom = pose.z + (part.size[2] if part.knob else 0.0)
        yaw = pose.yaw + (0.0 if grasped[0] <= grasped[1] else math.pi / 2) + turn
        x, y = pose.x + off_m * math.cos(yaw), pose.y + off_m * math.sin(yaw)
        self.open()
        self.go(x, y, bottom + grasped[2] / 2, yaw)
        self.close()
        self.go(x, y, TABLE_M + 0.25, yaw)

    def tool(self) -> tuple[float, float, float]:
        x, y, z = self.body.tool_pose()[:3, 3]
        return float(x), float(y), float(z)
