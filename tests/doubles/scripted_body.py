"""A small body without physics: straight motions, drawn pictures, and faults on demand."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from broken_camera import with_noise
from drawn_scene import HEAD_POSE, PARTS, TABLE_Z, DrawnScene, Resting

from mend.robots.arm.body import ArmRoom, NoWay, Reach, ToolPose
from mend.robots.arm.grasp import grasp_of
from mend.robots.arm.gripper import GripperModel
from mend.robots.body import CameraImage
from mend.robots.catalogue import Catalogue, Part
from mend.robots.link.messages import Location
from mend.robots.vision.color_model import ColorModel, Sample
from mend.robots.vision.projection import project
from mend.robots.vision.table_view import TableView, view_table
from mend.robots.vision.tracking import LastSeen
from mend.sim.tabletop.arm import GRIPPER
from mend.tasks.scene import Table

NEUTRAL = ToolPose(0.30, -0.85, 1.05, 0.0)
HAND_OVER = ToolPose(0.45, -0.20, 1.00, 0.0)
CYCLE_S = 1 / 60
GRIPPER_CYCLES = 12
SPOT_PX = 60


@dataclass
class ScriptedPath:
    waypoints: list[ToolPose]
    ends_at: str = ""

    @property
    def segments(self) -> int:
        return len(self.waypoints)


class ScriptedCamera:
    def __init__(self, body: "ScriptedBody", name: str, period_s: float) -> None:
        self._body, self._name, self._period_s = body, name, period_s
        self.pictures_taken = 0
        self._last: CameraImage | None = None
        self._rng = np.random.default_rng(5)

    @property
    def period_s(self) -> float:
        return self._period_s

    def pose(self) -> np.ndarray:
        return HEAD_POSE if self._name == "head" else forearm_pose(self._body.tool_pose())

    def capture(self) -> CameraImage:
        self.pictures_taken += 1
        scene = DrawnScene(self._body.placed(), self._body.grey_boxes)
        if self._name == "head":
            picture = scene.picture(time=self._body.time_s())
            if self._body.head_noisy:
                picture = with_noise(picture, 0.0003, self._rng)
            if self._last is not None and self._body.head_frozen:
                picture = replace(self._last, time=picture.time)
            self._last = picture
            if self._body.other_robot_at is not None:
                return behind_robot_at(picture, *self._body.other_robot_at)
            if self._body.head_covered_at is not None:
                return covered_at(picture, *self._body.head_covered_at)
            return covered(picture) if self._body.head_covered else picture
        return scene.picture(
            pose=self.pose(),
            width=160,
            height=120,
            focal_px=80.0,
            time=self._body.time_s(),
            with_depth=False,
        )


def covered(image: CameraImage) -> CameraImage:
    """What a covered camera gives instead."""
    assert image.depth_m is not None
    nothing = np.full_like(image.depth_m, np.nan)
    return replace(image, bgr=np.zeros_like(image.bgr), depth_m=nothing)


def behind_robot_at(image: CameraImage, x: float, y: float) -> CameraImage:
    """What a camera gives that another robot passes before, over a point of the table."""
    there = covered_at(image, x, y)
    assert there.depth_m is not None
    return replace(there, others=np.isnan(there.depth_m))


def covered_at(image: CameraImage, x: float, y: float) -> CameraImage:
    """What a camera gives that has a spot on its lens where it would show a point of the table."""
    assert image.depth_m is not None
    u, v = project(image, np.array([[x, y, TABLE_Z]]))[0]
    rows, columns = np.indices(image.depth_m.shape)
    spot = np.hypot(rows - v, columns - u) < SPOT_PX
    bgr, depth_m = image.bgr.copy(), image.depth_m.copy()
    bgr[spot], depth_m[spot] = 0, np.nan
    return replace(image, bgr=bgr, depth_m=depth_m)


def tool_matrix(pose: ToolPose) -> np.ndarray:
    cos, sin = math.cos(pose.yaw), math.sin(pose.yaw)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[0, cos, sin], [0, sin, -cos], [-1, 0, 0]])
    matrix[:3, 3] = pose.x, pose.y, pose.z
    return matrix


def forearm_pose(tool: np.ndarray) -> np.ndarray:
    """A camera behind and above the tool point, looking at it, fixed to the tool."""
    eye, forward = np.array([-0.18, 0.0, -0.22]), np.array([0.18, 0.0, 0.22])
    forward = forward / np.linalg.norm(forward)
    right = np.array([0.0, -1.0, 0.0])
    in_tool = np.eye(4)
    in_tool[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    in_tool[:3, 3] = eye
    return tool @ in_tool


class ScriptedBody:
    """Moves the tool point 0.8 m/s along straight lines; the gripper takes what it closes on.

    `at_cycle` is called at the beginning of every cycle, to script what happens to the parts.
    """

    def __init__(self, parts: dict[str, Resting], period_s: float = 1 / 30) -> None:
        self.parts: dict[str, Resting] = {name: replace(each) for name, each in parts.items()}
        self.grey_boxes: list = []
        self.head_covered = False
        self.head_covered_at: tuple[float, float] | None = None
        self.other_robot_at: tuple[float, float] | None = None
        self.head_frozen = False
        self.head_noisy = False
        self.bars: frozenset[str | None] = frozenset()
        """Around which things no path leads, by their names; None is something unknown."""
        self.in_hand: tuple[str, np.ndarray] | None = None
        self.held_out: tuple[str, np.ndarray] | None = None
        self.force_n = 0.0
        self.askew_m = 0.0
        """So much wider than they should the fingers close on what they take."""
        self.unplannable = False
        self.at_cycle: Callable[[], None] = lambda: None
        self.cycles = 0
        self.stops = 0
        self.speeds: list[float] = []
        self.tool = NEUTRAL
        self._from, self._to, self._length, self._done = NEUTRAL, NEUTRAL, 0.0, 0.0
        self._speed = 1.0
        self._arm_moving = False
        self._gripper_left = 0
        self._gripper_closed = False
        self._opened_m = GRIPPER.max_opening_m
        self._cameras = {
            "head": ScriptedCamera(self, "head", 0.1),
            "forearm": ScriptedCamera(self, "forearm", period_s),
        }

    # What a test does to the world.

    def vanish(self, name: str) -> None:
        self.parts.pop(name, None)
        if self.in_hand is not None and self.in_hand[0] == name:
            self.in_hand = None

    def hold_out(self, name: str) -> None:
        """A person holds a part between the fingers, wherever they are."""
        self.parts.pop(name, None)
        self.held_out = (name, part_in_tool(name))

    def placed(self) -> dict[str, object]:
        shown: dict[str, object] = dict(self.parts)
        for carried in (self.in_hand, self.held_out):
            if carried is not None:
                shown[carried[0]] = self.tool_pose() @ carried[1]
        return shown

    # The body.

    @property
    def control_period_s(self) -> float:
        return CYCLE_S

    @property
    def cameras(self) -> dict[str, ScriptedCamera]:
        return self._cameras

    @property
    def reach(self) -> Reach:
        return Reach((0.0, -0.2), 0.35, 0.80)

    @property
    def room(self) -> ArmRoom:
        return ArmRoom([(NEUTRAL.x, NEUTRAL.y)], (HAND_OVER.x, HAND_OVER.y), 0.1)

    def time_s(self) -> float:
        return self.cycles * CYCLE_S

    def advance_cycle(self) -> None:
        self.at_cycle()
        self.cycles += 1
        if self._arm_moving:
            self._advance_arm()
        if self._gripper_left:
            self._gripper_left -= 1
            if self._gripper_left == 0:
                self._end_gripper_motion()

    def plan_path(self, waypoints) -> ScriptedPath | None:
        beyond = any(
            math.hypot(each.x - self.reach.origin[0], each.y - self.reach.origin[1])
            > self.reach.max_m
            for each in waypoints
        )
        return None if self.unplannable or beyond else ScriptedPath(list(waypoints))

    def plan_back(self, waypoints) -> ScriptedPath | None:
        return self.plan_path(waypoints)

    def plan_among(self, legs, boxes) -> ScriptedPath | NoWay:
        bars = [box for box in boxes[1:] if box.name in self.bars]
        if bars:
            return NoWay("would touch something on the way", bars[0])
        path = self.plan_path([leg.to for leg in legs])
        return NoWay("finds no path") if path is None else path

    def plan_neutral(self) -> ScriptedPath:
        return ScriptedPath([NEUTRAL])

    def plan_hand_over(self) -> ScriptedPath:
        return ScriptedPath([HAND_OVER])

    def follow(self, path: ScriptedPath, segment: int, speed: float) -> None:
        self._from, self._to = self.tool, path.waypoints[segment]
        self._length = max(math.dist(_position(self._from), _position(self._to)), 1e-3)
        self._done, self._arm_moving = 0.0, True
        self.set_speed(speed)

    def set_speed(self, speed: float) -> None:
        self._speed = speed
        self.speeds.append(speed)

    def stop(self) -> None:
        self.stops += 1
        self._arm_moving = False

    @property
    def gripper(self) -> GripperModel:
        return GRIPPER

    def open_gripper(self, opening_m: float | None = None) -> None:
        self._opened_m = GRIPPER.max_opening_m if opening_m is None else opening_m
        self._gripper_left, self._gripper_closed = GRIPPER_CYCLES, False
        if self.in_hand is not None:
            name, relative = self.in_hand
            self.in_hand = None
            pose = self.tool_pose() @ relative
            yaw = math.atan2(pose[1, 0], pose[0, 0])
            self.parts[name] = Resting(pose[0, 3], pose[1, 3], TABLE_Z, yaw)

    def close_gripper(self) -> None:
        self._gripper_left, self._gripper_closed = GRIPPER_CYCLES, True

    @property
    def arm_moving(self) -> bool:
        return self._arm_moving

    @property
    def moving(self) -> bool:
        return self._arm_moving or self._gripper_left > 0

    @property
    def progress(self) -> float:
        if self._arm_moving:
            return min(self._done / self._length, 1.0)
        return 1.0 - self._gripper_left / GRIPPER_CYCLES

    def tool_pose(self) -> np.ndarray:
        return tool_matrix(self.tool)

    def gripper_opening_m(self) -> float:
        if not self._gripper_closed:
            return self._opened_m
        if self.in_hand is None:
            return 0.0
        return grasp_of(PARTS[self.in_hand[0]], GRIPPER).width_m + self.askew_m

    def gripper_effort_n(self) -> float:
        return GRIPPER.grip_force_n if self.in_hand is not None and self._gripper_closed else 0.0

    def finger_hulls(self) -> list[np.ndarray]:
        """It has no fingers to be seen."""
        return []

    def contact_force(self) -> np.ndarray:
        """What it feels pushes against its motion, and along if it is negative."""
        way = np.array(_position(self._to)) - _position(self._from)
        length = np.linalg.norm(way)
        return -self.force_n * (way / length if length > 0 else np.array([0.0, 0.0, 1.0]))

    def contact_force_n(self) -> float:
        return abs(self.force_n)

    def _advance_arm(self) -> None:
        self._done += 0.8 * self._speed * CYCLE_S
        share = min(self._done / self._length, 1.0)
        a, b = self._from, self._to
        self.tool = ToolPose(
            *(p + (q - p) * share for p, q in zip(_position(a), _position(b), strict=True)),
            a.yaw + (b.yaw - a.yaw) * share,
        )
        self._arm_moving = share < 1.0

    def _end_gripper_motion(self) -> None:
        if not self._gripper_closed or self.in_hand is not None:
            return
        if self.held_out is not None:
            self.in_hand, self.held_out = self.held_out, None
            return
        for name, resting in self.parts.items():
            relative = np.linalg.inv(self.tool_pose()) @ resting.matrix()
            if np.linalg.norm(relative[:3, 3] - part_in_tool(name)[:3, 3]) < 0.015:
                del self.parts[name]
                self.in_hand = (name, relative)
                return


def part_in_tool(name: str) -> np.ndarray:
    grasp = grasp_of(PARTS[name], GRIPPER)
    pose = grasp.tool_pose(0.0, 0.0, 0.0, 0.0)
    return np.linalg.inv(tool_matrix(pose))


def _position(pose: ToolPose) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.z


@cache
def trained_model() -> ColorModel:
    """Colours learned from one drawn picture of each part."""
    samples = {}
    for name in PARTS:
        bgr = DrawnScene({name: Resting(0.55, -0.2)}).picture().bgr
        empty = DrawnScene().picture().bgr
        samples[name] = [Sample(bgr, (bgr != empty).any(axis=2).astype(np.uint8))]
    return ColorModel.train(samples)


STARTS = {
    "green_leg": Resting(0.45, -0.50),
    "pink_bar": Resting(0.45, -0.30, yaw=0.2),
    "yellow_bar": Resting(0.55, -0.42, yaw=-0.1),
    "purple_top": Resting(0.66, -0.30),
}
PLACES = {
    "left": Location(x=0.55, y=0.05),
    "right": Location(x=0.45, y=0.15, yaw=0.3),
    "where_pink_is": Location(x=0.45, y=-0.30, yaw=0.2),
}


def catalogue() -> Catalogue:
    return Catalogue(PARTS, PLACES, Table())


def view_of(image: CameraImage, parts: Mapping[str, Part] = PARTS) -> TableView:
    """What a drawn head picture shows, with colours that were learned from drawn pictures."""
    view = view_table(image, Table(), parts, trained_model(), LastSeen())
    assert view is not None
    return view
