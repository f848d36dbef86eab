"""What the cameras of a tabletop world see: table, parts, gripper and whoever is in the way."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.body import ToolPose
from mend.robots.body import CameraImage, Matrix4
from mend.robots.vision.viewpoint import Viewpoint
from mend.sim.base_frame import base_in_scene, tool_in_base
from mend.sim.depth_noise import DepthNoise, PinholeOptics, exposures_from
from mend.sim.lighting import Lighting
from mend.sim.other_robots import around, blank
from mend.sim.raster import Light, Mesh, Rasterizer, RenderedImage, box_triangles
from mend.sim.tabletop.blocker import SIZE_M as BLOCKER_SIZE_M
from mend.sim.tabletop.gripper_shape import FINGER, PALM, finger_offset_m
from mend.sim.tabletop.manipulator import Manipulator
from mend.sim.tabletop.part import TablePart, UprightPose
from mend.sim.tabletop.state import CONTROL_PERIOD_S, TabletopState
from mend.tasks.part_boxes import boxes_of
from mend.tasks.scene import Table

HEAD_SIZE = (640, 480)
HEAD_FOCAL_PX = 526.0
HEAD_TILT_RAD = math.radians(30.0)
FOREARM_SIZE = (160, 120)
FOREARM_FOCAL_PX = 104.0
_FOREARM_BEHIND_M = 0.14
_FOREARM_ABOVE_M = 0.18

_TABLE_THICKNESS_M = 0.04
_FLOOR_BGR = (96, 96, 96)
_GREY = (0.45, 0.45, 0.45)
TABLE_COLOR = (0.72, 0.70, 0.68)
BLOCKER_COLOR = (0.30, 0.30, 0.32)
_GRIPPER = (FINGER, FINGER, np.concatenate(PALM))


@dataclass(frozen=True, slots=True)
class _PictureInputs:
    """All that a picture depends on."""

    poses: bytes
    visible: bytes
    camera: bytes
    focal_px: float
    light: Light


class Scenery:
    """Draws the state of a tabletop world."""

    def __init__(self, state: TabletopState) -> None:
        self._state = state
        self._parts = list(state.parts.values())
        table = state.scene.table
        top = box_triangles(
            (*table.size, _TABLE_THICKNESS_M),
            (*table.center, table.height - _TABLE_THICKNESS_M / 2),
        )
        self._rasterizer = Rasterizer(
            [
                *(Mesh(_triangles_of(part), part.color) for part in self._parts),
                *(Mesh(each, _GREY) for _ in state.manipulators for each in _GRIPPER),
                Mesh(box_triangles(BLOCKER_SIZE_M), BLOCKER_COLOR),
                Mesh(top, TABLE_COLOR),
            ]
        )
        self._blocker_index = len(self._parts) + len(_GRIPPER) * len(state.manipulators)
        count = self._blocker_index + 2
        self._transforms = np.tile(np.eye(4), (count, 1, 1))
        self._visible = np.ones(count, dtype=np.bool_)
        self._drawn: list[UprightPose | None] = [None] * len(self._parts)
        self._last: dict[object, tuple[_PictureInputs, RenderedImage]] = {}

    def render(
        self,
        camera: object,
        camera_pose: Matrix4,
        size: tuple[int, int],
        focal_px: float,
        light: Light,
    ) -> RenderedImage:
        """What a camera at `camera_pose` (scene's frame) sees now.

        Ids are the parts' indices in the scene, then those of the grippers. While nothing changes
        it is, for each `camera`, the very same, read-only picture.
        """
        self._place_parts()
        for number, manipulator in enumerate(self._state.manipulators):
            self._place_gripper(number, manipulator)
        self._place_blocker()
        poses, visible = self._transforms.tobytes(), self._visible.tobytes()
        shown = _PictureInputs(poses, visible, camera_pose.tobytes(), focal_px, light)
        last = self._last.get(camera)
        if last is not None and last[0] == shown:
            return last[1]
        rendered = self._rasterizer.render(
            self._transforms,
            camera_pose,
            size,
            focal_px,
            light=light,
            visible=self._visible,
            background=_FLOOR_BGR,
        )
        for each in (rendered.bgr, rendered.depth_m, rendered.ids):
            each.flags.writeable = False
        self._last[camera] = shown, rendered
        return rendered

    def other_bodies(self, manipulator: Manipulator) -> list[int]:
        """The ids of the other robots' grippers and of what they hold."""
        others = [
            (number, each)
            for number, each in enumerate(self._state.manipulators)
            if each is not manipulator
        ]
        first = len(self._parts)
        grippers = [
            first + len(_GRIPPER) * number + piece
            for number, _ in others
            for piece in range(len(_GRIPPER))
        ]
        return [
            *grippers,
            *(self._parts.index(each.held) for _, each in others if each.held is not None),
        ]

    def _place_parts(self) -> None:
        for index, part in enumerate(self._parts):
            self._visible[index] = part.visible
            if part.pose is not self._drawn[index]:
                pose = part.pose
                _set_upright(self._transforms[index], pose.x, pose.y, pose.z, pose.yaw)
                self._drawn[index] = pose

    def _place_gripper(self, number: int, manipulator: Manipulator) -> None:
        tool = manipulator.arm.pose
        half = finger_offset_m(manipulator.gripper.opening_m)
        dx, dy = half * math.cos(tool.yaw), half * math.sin(tool.yaw)
        first = len(self._parts) + len(_GRIPPER) * number
        _set_upright(self._transforms[first], tool.x + dx, tool.y + dy, tool.z, tool.yaw)
        _set_upright(self._transforms[first + 1], tool.x - dx, tool.y - dy, tool.z, tool.yaw)
        _set_upright(self._transforms[first + 2], tool.x, tool.y, tool.z, tool.yaw)

    def _place_blocker(self) -> None:
        index = self._blocker_index
        blocker = self._state.blocker
        self._visible[index] = blocker is not None
        if blocker is not None:
            middle = blocker.top_z - BLOCKER_SIZE_M[2] / 2
            _set_upright(self._transforms[index], blocker.x, blocker.y, middle, 0.0)


class TabletopCamera:
    """A camera in a tabletop world; subclasses say where it is and what it measures."""

    size: tuple[int, int]
    focal_px: float
    has_depth: bool

    def __init__(
        self,
        state: TabletopState,
        manipulator: Manipulator,
        scenery: Scenery,
        lighting: Lighting,
        depth_noise: DepthNoise,
    ) -> None:
        self._state = state
        self._manipulator = manipulator
        self._base = base_in_scene(manipulator.frame)
        self._scenery = scenery
        self._lighting = lighting
        self._depth_noise = depth_noise

    @property
    def period_s(self) -> float:
        return CONTROL_PERIOD_S

    def pose(self) -> Matrix4:
        """The optical frame in the base frame."""
        raise NotImplementedError

    def capture(self) -> CameraImage:
        image, _ = self.capture_with_ids()
        return image

    def capture_with_ids(self) -> tuple[CameraImage, NDArray[np.int32]]:
        """A picture, and which of the scene's objects each pixel shows (for training only)."""
        pose, time_s = self.pose(), self._state.time_s
        light = self._lighting.light_at(time_s)
        rendered = self._scenery.render(self, self._base @ pose, self.size, self.focal_px, light)
        center_px = _center_px(self.size)
        depth_m, others = None, None
        if self.has_depth:
            lens = PinholeOptics(self.focal_px, center_px)
            others = self._other_robots(rendered.ids)
            measured_m = self._depth_noise.measure(rendered.depth_m, rendered.bgr, lens)
            depth_m = blank(measured_m, others)
        image = CameraImage(
            bgr=self._lighting.expose(rendered.bgr, time_s),
            depth_m=depth_m,
            pose=pose,
            focal_px=self.focal_px,
            center_px=center_px,
            time=time_s,
            others=others,
        )
        return image, rendered.ids

    def _other_robots(self, ids: NDArray[np.int32]) -> NDArray[np.bool_] | None:
        """Where robots are that say where they are."""
        others = self._scenery.other_bodies(self._manipulator)
        return around(np.isin(ids, others)) if others else None


class HeadCamera(TabletopCamera):
    """Looks down on the whole table from above its near edge, with depth."""

    size = HEAD_SIZE
    focal_px = HEAD_FOCAL_PX
    has_depth = True

    def __init__(
        self,
        state: TabletopState,
        manipulator: Manipulator,
        scenery: Scenery,
        lighting: Lighting,
        depth_noise: DepthNoise,
    ) -> None:
        super().__init__(state, manipulator, scenery, lighting, depth_noise)
        self._pose = look_at_table(manipulator.frame.table_to_robot(state.scene.table))

    def pose(self) -> Matrix4:
        return self._pose


class ForearmCamera(TabletopCamera):
    """Moves with the tool and looks at the tool point from behind and above."""

    size = FOREARM_SIZE
    focal_px = FOREARM_FOCAL_PX
    has_depth = False

    def pose(self) -> Matrix4:
        return _forearm_pose(tool_in_base(self._manipulator.frame, self._manipulator.arm.pose))


def _forearm_pose(tool: ToolPose) -> Matrix4:
    """Beside the plane in which the fingers move, so that no finger hides what they hold."""
    cos, sin = math.cos(tool.yaw), math.sin(tool.yaw)
    aside = np.array([sin, -cos, 0.0])
    offset = aside * _FOREARM_BEHIND_M + np.array([0.0, 0.0, _FOREARM_ABOVE_M])
    position = np.array([tool.x, tool.y, tool.z]) + offset
    return _optical_frame(position, -offset, np.array([cos, sin, 0.0]))


def look_at_table(table: Table) -> Matrix4:
    """As near as the camera can be and still see the whole table and what stands on it."""
    target = np.array([*table.center, table.height])
    forward = np.array([math.sin(HEAD_TILT_RAD), 0.0, -math.cos(HEAD_TILT_RAD)])
    right = np.array([0.0, -1.0, 0.0])
    frame = _optical_frame(target, forward, right)
    limits = np.array(HEAD_SIZE) / 2 / HEAD_FOCAL_PX * 0.96
    distance = 0.0
    for corner in _corners(table.size, 0.15):
        seen = frame[:3, :3].T @ corner
        distance = max(distance, float((np.abs(seen[:2]) / limits - seen[2]).max()))
    return _optical_frame(target - forward * distance, forward, right)


def head_viewpoint(table: Table) -> Viewpoint:
    """What the head camera sees from where it is."""
    return Viewpoint(look_at_table(table), HEAD_SIZE, HEAD_FOCAL_PX, _center_px(HEAD_SIZE))


def head_exposures(table: Table) -> int:
    """So many exposures the head camera fuses: the more, the farther away the table makes it be."""
    away = look_at_table(table)[:3, 3] - np.array([*table.center, table.height])
    return exposures_from(float(np.linalg.norm(away)))


def _center_px(size: tuple[int, int]) -> tuple[float, float]:
    return (size[0] - 1) / 2, (size[1] - 1) / 2


def _corners(size: Sequence[float], height: float) -> list[NDArray[np.float64]]:
    return [
        np.array([x * size[0] / 2, y * size[1] / 2, z])
        for x in (-1, 1)
        for y in (-1, 1)
        for z in (0.0, height)
    ]


def _optical_frame(
    position: NDArray[np.float64], forward: NDArray[np.float64], right: NDArray[np.float64]
) -> Matrix4:
    pose = np.eye(4)
    pose[:3, 2] = forward / np.linalg.norm(forward)
    pose[:3, 0] = right
    pose[:3, 1] = np.cross(pose[:3, 2], right)
    pose[:3, 3] = position
    return pose


def _triangles_of(part: TablePart) -> NDArray[np.float64]:
    boxes = boxes_of(part.size, part.knob)
    return np.concatenate(
        [box_triangles(size, (0.0, 0.0, bottom_m + size[2] / 2)) for bottom_m, size in boxes]
    )


def _set_upright(transform: Matrix4, x: float, y: float, z: float, yaw: float) -> None:
    cos, sin = math.cos(yaw), math.sin(yaw)
    transform[0, 0] = transform[1, 1] = cos
    transform[0, 1], transform[1, 0] = -sin, sin
    transform[0, 3], transform[1, 3], transform[2, 3] = x, y, z
