"""Coloured boxes drawn under a known camera, with depth."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mend.robots.body import CameraImage
from mend.robots.catalogue import Part

TABLE_Z = 0.70
TABLE = ((0.35, -0.75), (1.05, 0.55))
COLORS = {
    "green_leg": (30, 140, 20),
    "pink_bar": (165, 90, 250),
    "yellow_bar": (15, 215, 245),
    "blue_leg": (215, 50, 20),
    "purple_top": (150, 20, 105),
}
PARTS = {
    "green_leg": Part("green_leg", (0.03, 0.20, 0.08)),
    "pink_bar": Part("pink_bar", (0.112, 0.03, 0.04)),
    "yellow_bar": Part("yellow_bar", (0.112, 0.03, 0.04), needs_help=True),
    "blue_leg": Part("blue_leg", (0.03, 0.20, 0.08)),
    "purple_top": Part("purple_top", (0.18, 0.22, 0.016), knob=(0.028, 0.04, 0.036)),
}
_FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))


@dataclass
class Resting:
    """Where a part's bottom centre is."""

    x: float
    y: float
    z: float = TABLE_Z
    yaw: float = 0.0

    def matrix(self) -> NDArray[np.float64]:
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return np.array(
            [[cos, -sin, 0, self.x], [sin, cos, 0, self.y], [0, 0, 1, self.z], [0, 0, 0, 1.0]]
        )


def on_its_side(part: Part, at: Resting, about: str) -> NDArray[np.float64]:
    """Turned by 90 degrees about one of its own axes."""
    turn = Rotation.from_euler(about, 90, degrees=True).as_matrix()
    half_m = part.size[1 if about == "x" else 0] / 2
    middle = np.eye(4)
    middle[:3, :3] = turn
    middle[:3, 3] = (0.0, 0.0, half_m) - turn @ (0.0, 0.0, part.size[2] / 2)
    return at.matrix() @ middle


def look_at(eye: tuple[float, float, float], target: tuple[float, float, float]):
    """An optical frame at `eye` that looks at `target`, its picture's up being up."""
    forward = np.array(target) - np.array(eye)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right = right / np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    pose[:3, 3] = eye
    return pose


HEAD_POSE = look_at((-0.05, 0.0, 1.35), (0.58, -0.15, 0.70))


@dataclass
class DrawnScene:
    """A table, coloured parts (poses as 4x4 matrices or `Resting`), grey boxes."""

    parts: dict[str, object] = field(default_factory=dict)
    grey_boxes: list[tuple[tuple[float, float, float], tuple[float, float, float]]] = field(
        default_factory=list
    )
    noise: float = 0.0
    light: float = 1.0
    seed: int = 0
    built: Mapping[str, Part] = field(default_factory=lambda: PARTS)

    def picture(
        self, pose=HEAD_POSE, width=640, height=480, focal_px=526.0, time=0.0, with_depth=True
    ) -> CameraImage:
        canvas = _Canvas(pose, width, height, focal_px)
        (x0, y0), (x1, y1) = TABLE
        center, size = ((x0 + x1) / 2, (y0 + y1) / 2, TABLE_Z - 0.04), (x1 - x0, y1 - y0, 0.04)
        canvas.box(Resting(*center).matrix(), size, (190, 200, 205))
        for middle, extents in self.grey_boxes:
            canvas.box(Resting(*middle).matrix(), extents, (95, 92, 90))
        for name, where in self.parts.items():
            matrix = where.matrix() if isinstance(where, Resting) else where
            part = self.built[name]
            canvas.box(matrix, part.size, COLORS[name])
            if part.knob is not None:
                raised = matrix.copy()
                raised[:3, 3] += matrix[:3, 2] * part.size[2]
                canvas.box(raised, part.knob, COLORS[name])
        return CameraImage(
            bgr=self._expose(canvas.bgr),
            depth_m=canvas.depth.astype(np.float32) if with_depth else None,
            pose=pose,
            focal_px=focal_px,
            center_px=(width / 2 - 0.5, height / 2 - 0.5),
            time=time,
        )

    def _expose(self, bgr: NDArray[np.uint8]) -> NDArray[np.uint8]:
        if self.noise == 0.0 and self.light == 1.0:
            return bgr
        noise = np.random.default_rng(self.seed).normal(0, self.noise, bgr.shape)
        return np.clip(bgr * self.light + noise, 0, 255).astype(np.uint8)


class _Canvas:
    def __init__(self, pose, width, height, focal_px) -> None:
        self._pose, self._focal = pose, focal_px
        self._center = np.array([width / 2 - 0.5, height / 2 - 0.5])
        self._rays = _rays(width, height, focal_px)
        self.bgr = np.full((height, width, 3), 120, np.uint8)
        self.depth = np.full((height, width), 3.0)

    def box(self, matrix, size, bgr) -> None:
        signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0, 1)])
        corners = (signs * np.array(size)) @ matrix[:3, :3].T + matrix[:3, 3]
        optical = (corners - self._pose[:3, 3]) @ self._pose[:3, :3]
        if optical[:, 2].min() < 0.01:
            return
        middle = optical.mean(axis=0)
        for index, face in enumerate(_FACES):
            self._face(optical[list(face)], middle, np.array(bgr) * (0.6 + 0.08 * index))

    def _face(self, corners, middle, bgr) -> None:
        """One side of a box around `middle`, in the optical frame; nothing if it faces away."""
        first, second = corners[1] - corners[0], corners[3] - corners[0]
        normal = np.cross(first, second)
        away = corners[0] @ normal
        if away * ((corners[0] - middle) @ normal) >= 0.0:
            return
        pixels = corners[:, :2] / corners[:, 2:] * self._focal + self._center
        height, width = self.depth.shape
        low = np.clip(np.floor(pixels.min(axis=0)), 0, (width, height)).astype(int)
        high = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, (width, height)).astype(int)
        seen = slice(low[1], high[1]), slice(low[0], high[0])
        rays, depths = self._rays[seen], self.depth[seen]
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = away / (rays @ normal)
            along, across = (
                depth * (rays @ side) - corners[0] @ side
                for side in (first / (first @ first), second / (second @ second))
            )
            inside = (np.abs(along - 0.5) <= 0.5) & (np.abs(across - 0.5) <= 0.5)
            front = inside & (depth > 0.01) & (depth < depths)
        depths[front] = depth[front]
        self.bgr[seen][front] = np.clip(bgr, 0, 255)


@lru_cache(maxsize=8)
def _rays(width: int, height: int, focal_px: float) -> NDArray[np.float64]:
    """Through each pixel (height, width, 3), in the optical frame, 1 m deep."""
    us, vs = np.meshgrid(np.arange(width), np.arange(height))
    center = (width / 2 - 0.5, height / 2 - 0.5)
    aside, down = (us - center[0]) / focal_px, (vs - center[1]) / focal_px
    return np.stack([aside, down, np.ones_like(aside)], axis=2)
