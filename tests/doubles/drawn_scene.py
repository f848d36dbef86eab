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
_SIGNS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0, 1)])
_FACES = np.array(
    [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
)
"""Of a box: its corners, and its sides by their numbers."""


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
        if pose is HEAD_POSE:
            canvas.begin_with(*_table_seen_by_head(width, height, focal_px))
        else:
            canvas.table()
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

    def begin_with(self, bgr, depth) -> None:
        self.bgr[:], self.depth[:] = bgr, depth

    def table(self) -> None:
        (x0, y0), (x1, y1) = TABLE
        center, size = ((x0 + x1) / 2, (y0 + y1) / 2, TABLE_Z - 0.04), (x1 - x0, y1 - y0, 0.04)
        self.box(Resting(*center).matrix(), size, (190, 200, 205))

    def box(self, matrix, size, bgr) -> None:
        corners = (_SIGNS * np.array(size)) @ matrix[:3, :3].T + matrix[:3, 3]
        optical = (corners - self._pose[:3, 3]) @ self._pose[:3, :3]
        if optical[:, 2].min() < 0.01:
            return
        middle, faces = optical.mean(axis=0), optical[_FACES]
        first, second = faces[:, 1] - faces[:, 0], faces[:, 3] - faces[:, 0]
        normals = _crossed(first, second)
        aways = (faces[:, 0] * normals).sum(axis=1)
        shown = aways * ((faces[:, 0] - middle) * normals).sum(axis=1) < 0.0
        low, high = self._within(faces)
        for face in np.flatnonzero(shown & (low < high).all(axis=1)):
            seen = slice(low[face, 1], high[face, 1]), slice(low[face, 0], high[face, 0])
            sides = first[face], second[face]
            shade = np.clip(np.array(bgr) * (0.6 + 0.08 * face), 0, 255)
            self._fill(seen, faces[face, 0], sides, normals[face], aways[face], shade)

    def _within(self, faces):
        """From where to where each face reaches in the picture: (n, 2) columns and rows."""
        pixels = faces[:, :, :2] / faces[:, :, 2:] * self._focal + self._center
        most = self.depth.shape[::-1]
        low = np.clip(np.floor(pixels.min(axis=1)), 0, most).astype(int)
        return low, np.clip(np.ceil(pixels.max(axis=1)) + 1, 0, most).astype(int)

    def _fill(self, seen, corner, sides, normal, away, bgr) -> None:
        """One side of a box, in the optical frame, where it is nearer than what is drawn."""
        rays, depths = self._rays[seen], self.depth[seen]
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = away / (rays @ normal)
            along, across = (
                depth * (rays @ side) - corner @ side
                for side in (each / (each @ each) for each in sides)
            )
            inside = (np.abs(along - 0.5) <= 0.5) & (np.abs(across - 0.5) <= 0.5)
            front = inside & (depth > 0.01) & (depth < depths)
        depths[front] = depth[front]
        self.bgr[seen][front] = bgr


@lru_cache(maxsize=2)
def _table_seen_by_head(width, height, focal_px):
    """Where the head is it fills the picture, which is drawn once."""
    canvas = _Canvas(HEAD_POSE, width, height, focal_px)
    canvas.table()
    return canvas.bgr, canvas.depth


def _crossed(first, second):
    """The cross product of each two rows; that of NumPy takes ten times as long for so few."""
    (ax, ay, az), (bx, by, bz) = first.T, second.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)


@lru_cache(maxsize=8)
def _rays(width: int, height: int, focal_px: float) -> NDArray[np.float64]:
    """Through each pixel (height, width, 3), in the optical frame, 1 m deep."""
    us, vs = np.meshgrid(np.arange(width), np.arange(height))
    center = (width / 2 - 0.5, height / 2 - 0.5)
    aside, down = (us - center[0]) / focal_px, (vs - center[1]) / focal_px
    return np.stack([aside, down, np.ones_like(aside)], axis=2)
