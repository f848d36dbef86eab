"""The PR2's head camera (RGB-D) and forearm camera (RGB)."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.motion.kinematics import KinematicChain
from mend.robots.body import CameraImage, Matrix4
from mend.robots.vision.viewpoint import Viewpoint
from mend.sim.depth_noise import DepthNoise, PinholeOptics
from mend.sim.lighting import Lighting
from mend.sim.other_robots import around, blank
from mend.sim.raster import Light
from mend.sim.workcell.rendering import CameraOptics, Renderer, Rendering
from mend.sim.workcell.robot_model import (
    FOREARM_FOV_RAD,
    HEAD_CAMERA_FRAME,
    HEAD_FOV_RAD,
    robot_urdf,
)

HEAD_SIZE = (640, 480)
FOREARM_SIZE = (160, 120)

_STILL = 1e-5
"""Metres, or radians, that no camera here sees: a hundredth of a pixel.

Joints that are held tremble by a tenth of it.
"""


@dataclass(frozen=True, slots=True)
class Optics:
    """What does not change about a camera."""

    size: tuple[int, int]
    focal_px: float
    near_m: float
    period_s: float
    has_depth: bool


def head_optics() -> Optics:
    """The head's wide stereo camera; it takes pictures when asked."""
    focal_px = HEAD_SIZE[1] / 2 / math.tan(HEAD_FOV_RAD / 2)
    return Optics(HEAD_SIZE, focal_px, near_m=0.1, period_s=0.1, has_depth=True)


@cache
def head_camera_pose() -> Matrix4:
    """Where the head camera is, which does not move: its optical frame in the base frame."""
    return KinematicChain(robot_urdf(), HEAD_CAMERA_FRAME, ()).pose(np.zeros(0))


def head_viewpoint() -> Viewpoint:
    """What the head camera sees from where it is."""
    optics = head_optics()
    view = CameraOptics(head_camera_pose(), optics.size, optics.focal_px, optics.near_m)
    return Viewpoint(view.pose, view.size, view.focal_px, view.center_px)


def forearm_optics(period_s: float) -> Optics:
    """The camera on the forearm that looks at the gripper."""
    focal_px = FOREARM_SIZE[0] / 2 / math.tan(FOREARM_FOV_RAD / 2)
    return Optics(FOREARM_SIZE, focal_px, near_m=0.02, period_s=period_s, has_depth=False)


@dataclass(frozen=True, slots=True)
class Mount:
    """Where a camera is: its `pose` in the frame of its robot, which `base` has in the scene's.

    `other_bodies` are the engine's ids of the other robots, and of what they hold.
    """

    base: Matrix4
    pose: Callable[[], Matrix4]
    other_bodies: Callable[[], list[int]]


@dataclass(frozen=True, slots=True, eq=False)
class _Drawn:
    """What was drawn last, and of what."""

    arrangement: NDArray[np.float64]
    light: Light
    rendering: Rendering

    def is_still(self, arrangement: NDArray[np.float64], light: Light) -> bool:
        """Whether nothing has moved since by as much as can be seen."""
        return (
            self.light == light
            and self.arrangement.shape == arrangement.shape
            and bool(np.abs(self.arrangement - arrangement).max(initial=0.0) < _STILL)
        )


class WorkcellCamera:
    """One camera: renders from where it is now, in the world's light."""

    def __init__(
        self,
        optics: Optics,
        renderer: Renderer,
        lighting: Lighting,
        depth_noise: DepthNoise,
        mount: Mount,
        time_s: Callable[[], float],
        arrangement: Callable[[], NDArray[np.float64]],
    ) -> None:
        """`arrangement` tells where everything is: it differs once anything has moved."""
        self._optics = optics
        self._renderer = renderer
        self._lighting = lighting
        self._depth_noise = depth_noise
        self._mount = mount
        self._time_s = time_s
        self._arrangement = arrangement
        self._last: tuple[NDArray[np.float64], CameraImage] | None = None
        self._drawn: _Drawn | None = None

    @property
    def period_s(self) -> float:
        return self._optics.period_s

    def pose(self) -> Matrix4:
        """Where it is now: its optical frame in the base frame."""
        return self._mount.pose()

    def capture(self) -> CameraImage:
        """Take a picture now; while neither time passes nor anything moves it is the same one."""
        now = self._arrangement()
        last = self._last
        if last is None or last[1].time != self._time_s() or not np.array_equal(last[0], now):
            last = self._last = now, self._picture_of(now)[0]
        return last[1]

    def capture_with_bodies(self) -> tuple[CameraImage, Rendering]:
        """A picture and what it was rendered to, for training and for tests to judge by."""
        return self._picture_of(self._arrangement())

    def _picture_of(self, arrangement: NDArray[np.float64]) -> tuple[CameraImage, Rendering]:
        optics, pose, time_s = self._optics, self.pose(), self._time_s()
        in_scene = self._mount.base @ pose
        view = CameraOptics(in_scene, optics.size, optics.focal_px, optics.near_m)
        rendering = self._draw(arrangement, view, self._lighting.light_at(time_s))
        lens = PinholeOptics(optics.focal_px, view.center_px)
        depth_m, others = None, None
        if optics.has_depth:
            others = self._other_robots(rendering)
            measured_m = self._depth_noise.measure(rendering.depth_m, rendering.bgr, lens)
            depth_m = blank(measured_m, others)
        image = CameraImage(
            bgr=self._lighting.expose(rendering.bgr, time_s),
            depth_m=depth_m,
            pose=pose,
            focal_px=optics.focal_px,
            center_px=view.center_px,
            time=time_s,
            others=others,
        )
        return image, rendering

    def _draw(
        self, arrangement: NDArray[np.float64], view: CameraOptics, light: Light
    ) -> Rendering:
        """What is seen from where the camera is: drawn anew once anything has moved."""
        drawn = self._drawn
        if drawn is None or not drawn.is_still(arrangement, light):
            rendering = self._renderer.render(view, light)
            drawn = self._drawn = _Drawn(arrangement, light, rendering)
        return drawn.rendering

    def _other_robots(self, rendering: Rendering) -> NDArray[np.bool_] | None:
        """Where robots are that say where they are."""
        others = self._mount.other_bodies()
        return around(np.isin(rendering.bodies, others)) if others else None
