"""A robot's hands in a workcell, driven by what tests know; and how far a part is from a place."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from mend.robots.arm.body import ArmPath, ToolPose
from mend.robots.arm.grasp import RELEASE_CLEARANCE_M, grasp_of, half_turn
from mend.robots.catalogue import Part
from mend.sim.base_frame import tool_in_base
from mend.sim.workcell.parts import PartPose
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.frames import Frame
from mend.tasks.intervention import Act, Intervention

TABLE_M = 0.70
APPROACH_M = 0.14

Direction = npt.NDArray[np.float64]


def do(world: WorkcellWorld, act: Act, name: str | None = None, **more: object) -> str:
    """Let a person intervene."""
    return world.intervene(Intervention(act=act, object=name, **more))  # type: ignore[arg-type]


class Hands:
    """Picks and places parts where they really are; `frame` is where the robot stands."""

    def __init__(self, world: WorkcellWorld, number: int = 0, frame: Frame | None = None) -> None:
        self.world = world
        self.body = world.bodies[number]
        self.frame = frame or Frame()

    def wait(self, duration_s: float) -> None:
        end_s = self.body.time_s() + duration_s
        while self.body.time_s() < end_s:
            self.body.advance_cycle()

    def settle(self, until: Callable[[], bool] = lambda: False) -> None:
        """Go on until nothing moves any more, or something is so."""
        while self.body.moving and not until():
            self.body.advance_cycle()

    def follow(
        self, path: ArmPath, segment: int, speed: float, until: Callable[[], bool] = lambda: False
    ) -> None:
        self.body.follow(path, segment, speed)
        self.settle(until)

    def plan(self, *waypoints: ToolPose) -> ArmPath:
        path = self.body.plan_path(waypoints)
        assert path is not None
        return path

    def pick(self, name: str, seen: PartPose | None = None) -> None:
        """Take a part from where it is, or is seen, and lift it."""
        pick = self._tool_pose(name, seen or self.world.parts[name].pose(), 0.0)
        path = self.plan(above(pick), pick, above(pick))
        self.follow(path, 0, 1.0)
        self.follow(path, 1, 0.5)
        self.body.close_gripper()
        self.settle()
        self.follow(path, 2, 0.5)

    def place(self, name: str, place: PartPose) -> None:
        """Put down what is held, and move to neutral."""
        tool = self.body.tool_pose()
        yaw = math.atan2(tool[1, 1], tool[0, 1])
        pose = self._tool_pose(name, place, RELEASE_CLEARANCE_M)
        pose = replace(pose, yaw=yaw + half_turn(pose.yaw - yaw))
        path = self.plan(above(pose), pose, above(pose))
        self.follow(path, 0, 0.75)
        self.follow(path, 1, 0.3)
        self.wait(0.1)
        self.body.open_gripper()
        self.settle()
        self.follow(path, 2, 0.5)
        self.go_neutral()

    def go_neutral(self) -> None:
        self.follow(self.body.plan_neutral(), 0, 0.6)

    def go_hand_over(self) -> None:
        self.follow(self.body.plan_hand_over(), 0, 1.0)

    def pressing(self, name: str) -> list[Direction]:
        """The directions in which a part is pressed, in the base frame."""
        contacts = self.world._client.getContactPoints(self.world.parts[name].body_id)
        return [np.array(each[7]) for each in contacts if each[9] > 0.0]

    def _tool_pose(self, name: str, pose: PartPose, clearance_m: float) -> ToolPose:
        definition = self.world.parts[name].definition
        grasp = grasp_of(Part(name, definition.size, definition.knob), self.body.gripper)
        x, y, z = pose.position
        in_scene = grasp.tool_pose(x, y, z + clearance_m, pose.yaw)
        return tool_in_base(self.frame, in_scene)


def above(pose: ToolPose) -> ToolPose:
    return replace(pose, z=pose.z + APPROACH_M)


def distance_m(one: PartPose, other: PartPose) -> float:
    return math.dist(one.position, other.position)
