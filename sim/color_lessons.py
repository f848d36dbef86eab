"""Training pictures for a colour model: a box of each colour on a table, without physics."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import Matrix4
from mend.robots.vision.color_model import (
    ColorModel,
    ColorSettings,
    LearnedColor,
    Sample,
    Tint,
    learn,
)
from mend.sim.lighting import Lighting
from mend.sim.raster import Light, Mesh, Rasterizer, RenderedImage, box_triangles
from mend.tasks.scene import Scene

Color = tuple[float, float, float]

_BOX_M = 0.06
_SIZE_PX = (96, 72)
_FOCAL_PX = 130.0
_DISTANCE_M = 0.35
_TILT_RAD = math.radians(35.0)
_YAWS_RAD = (0.0, 0.8, 2.2)
_VARIATIONS = (0.0, 1.0, 1.0)
"""How far the light of each lesson is from the usual."""
_SEED = 3


@dataclass(frozen=True, slots=True)
class Studio:
    """What a world's pictures have in common: the table's colour and the usual light."""

    table_color: Color
    light: Light


def teach_colors(scene: Scene, studio: Studio, camera_noise: float) -> ColorModel:
    """The colour model of all objects of a scene, for a world's cameras."""
    settings = ColorSettings()
    learned = {
        name: _learn(each.color, studio, camera_noise) for name, each in scene.objects.items()
    }
    return ColorModel(
        {name: look for name, (look, _) in learned.items()},
        settings,
        {name: tint for name, (_, tint) in learned.items()},
    )


@lru_cache(maxsize=4096)
def _learn(color: Color, studio: Studio, camera_noise: float) -> tuple[LearnedColor, Tint]:
    """Scenes share their colours, so one is learned but once."""
    rng = np.random.default_rng(_SEED)
    samples = []
    for yaw, variation in zip(_YAWS_RAD, _VARIATIONS, strict=True):
        lighting = Lighting(studio.light, variation, camera_noise, rng)
        drawn = _draw(color, studio, yaw, lighting.light_at(0.0))
        samples.append(Sample(lighting.expose(drawn.bgr, 0.0), (drawn.ids == 0).astype(np.uint8)))
    name = f"a box of the colour {color}"
    return learn(name, samples, ColorSettings()), _tint(color, studio)


def _tint(color: Color, studio: Studio) -> Tint:
    drawn = _draw(color, studio, 0.0, studio.light)
    middle = (_SIZE_PX[1] // 2, _SIZE_PX[0] // 2)
    top, table = drawn.bgr[middle].astype(float), drawn.bgr[2, 2].astype(float)
    blue, green, red = (float(each) for each in (top + 0.5) / (table + 0.5))
    return blue, green, red


def _draw(color: Color, studio: Studio, yaw: float, light: Light) -> RenderedImage:
    box = Mesh(box_triangles((_BOX_M,) * 3, (0.0, 0.0, -_BOX_M / 2)), color)
    table = Mesh(box_triangles((2.0, 2.0, 0.04), (0.0, 0.0, -_BOX_M - 0.02)), studio.table_color)
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[0, :2, :2] = [[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]]
    return Rasterizer([box, table]).render(poses, _camera(), _SIZE_PX, _FOCAL_PX, light=light)


def _camera() -> Matrix4:
    """Above the box, looking down at the middle of its top."""
    forward = np.array([math.sin(_TILT_RAD), 0.0, -math.cos(_TILT_RAD)])
    right = np.array([0.0, -1.0, 0.0])
    pose: NDArray[np.float64] = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    pose[:3, 3] = -forward * _DISTANCE_M
    return pose
