"""A made-up drive as a log, with the truth as its reference."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.localization.logs.log import Log, LogStep
from mend.localization.pose import Poses, relative, wrap
from mend.localization.scan import Scan
from mend.maps.ray_cast import cast
from mend.maps.vector_map import VectorMap
from synthetic.free_space import free_space
from synthetic.furniture import boxes
from synthetic.path import drive
from synthetic.people import people
from synthetic.rough_laser import RoughDrive
from synthetic.settings import (
    LaserSettings,
    OdometrySettings,
    SceneSettings,
)

Matrix = NDArray[np.float64]

EXPLAINED_WITHIN_M = 0.15
"""A return is explained by the map when it is this close to what the map foretells."""
_BOXES_PER_M = 6.0
"""The most furniture that is put up, per metre of the way."""
_SAMPLES = 60
"""Poses at which the explained share is measured."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A drive and what it led through. `explained` is the share that was reached."""

    log: Log
    truth: Poses
    furniture: Matrix
    walls: Matrix
    explained: float


def scene(vector_map: VectorMap, settings: SceneSettings, seed: int) -> Scene:
    """Drive over a map. The same seed gives the same drive. Raises `WrongInputError`."""
    generator = np.random.default_rng(seed)
    space = free_space(vector_map, settings.clearance_m)
    way = drive(space, settings.length_m, settings.step_m, generator)
    times_s = np.arange(len(way), dtype=np.float64) * (settings.step_m / settings.speed_m_per_s)
    there = generator.random(len(vector_map)) >= settings.removed
    walls = vector_map.segments[there]
    crowd = people(way, times_s, settings.people, generator)
    sides = boxes(way, int(_BOXES_PER_M * settings.length_m), generator)

    def around(index: int, count: int) -> Matrix:
        parts = (walls, sides[:count].reshape(-1, 4), crowd.segments(float(times_s[index])))
        return np.ascontiguousarray(np.vstack(parts))

    sampled = np.linspace(0, len(way) - 1, min(_SAMPLES, len(way))).astype(int)

    def explained(count: int) -> float:
        return float(
            np.mean(
                [_explained(vector_map, around(at, count), way[at], settings) for at in sampled]
            )
        )

    few, many = 0, len(sides)
    while few < many:
        middle = (few + many) // 2
        if explained(middle) <= settings.explained:
            many = middle
        else:
            few = middle + 1
    count = few if settings.explained < 1.0 else 0
    motions = _odometry(way, settings.odometry, generator)
    rough = None
    if settings.rough is not None:
        rough = RoughDrive.of(settings.rough, len(walls), way, generator)
    steps = tuple(
        LogStep(
            motions[index],
            _scan(
                _ranges(index, around(index, count), way[index], settings, rough, generator),
                settings.laser,
                float(time_s),
            ),
            way[index],
        )
        for index, time_s in enumerate(times_s)
    )
    log = Log(f"{vector_map.name or 'made-up'}-{seed}", steps)
    return Scene(log, way, sides[:count].reshape(-1, 4), walls, explained(count))


def _ranges(
    index: int,
    surroundings: Matrix,
    pose: Poses,
    settings: SceneSettings,
    rough: RoughDrive | None,
    generator: np.random.Generator,
) -> Matrix:
    """What is measured at a step of the way; inf where nothing comes back."""
    laser = settings.laser
    angles, reach_m = _beams(laser)[0], laser.max_range_m
    if rough is not None:
        return rough.ranges(index, surroundings, pose, angles, reach_m, generator)
    ranges, hit = cast(surroundings, float(pose[0]), float(pose[1]), pose[2] + angles, reach_m)
    noisy = np.maximum(ranges + generator.normal(0.0, laser.noise_m, laser.beams), 0.01)
    return np.where(hit >= 0, noisy, np.inf)


def _scan(ranges_m: Matrix, laser: LaserSettings, time_s: float) -> Scan:
    angles, increment = _beams(laser)
    return Scan(ranges_m, float(angles[0]), increment, laser.max_range_m, time_s)


def _beams(laser: LaserSettings) -> tuple[Matrix, float]:
    increment = laser.field_of_view_rad / (laser.beams - 1)
    beams = np.arange(laser.beams, dtype=np.float64)
    return -laser.field_of_view_rad / 2.0 + beams * increment, increment


def _explained(
    vector_map: VectorMap, surroundings: Matrix, pose: Poses, settings: SceneSettings
) -> float:
    """The share of the returns at a pose that are where the map foretells them."""
    angles = pose[2] + _beams(settings.laser)[0]
    x, y, reach = float(pose[0]), float(pose[1]), settings.laser.max_range_m
    seen, hit = cast(surroundings, x, y, angles, reach)
    foretold, _ = cast(vector_map.segments, x, y, angles, reach + EXPLAINED_WITHIN_M)
    returned = hit >= 0
    if not returned.any():
        return 1.0
    return float(np.mean(np.abs(seen - foretold)[returned] < EXPLAINED_WITHIN_M))


def _odometry(way: Poses, settings: OdometrySettings, generator: np.random.Generator) -> Poses:
    """The motions (n, 3) between poses, as wheels would tell them; the first is zero."""
    motions = np.zeros_like(way)
    motions[1:] = relative(way[:-1], way[1:])
    root_m = np.sqrt(np.hypot(motions[:, 0], motions[:, 1]))
    root_rad = np.sqrt(np.abs(motions[:, 2]))
    deviations = np.column_stack(
        (
            settings.along_m_per_sqrt_m * root_m,
            settings.across_m_per_sqrt_m * root_m,
            np.hypot(settings.turn_rad_per_sqrt_m * root_m, settings.turn_share * root_rad),
        )
    )
    told: Matrix = motions + generator.normal(0.0, 1.0, motions.shape) * deviations
    told[:, 2] = wrap(told[:, 2])
    return told
