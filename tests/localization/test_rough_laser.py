"""The second laser of made-up drives errs as its dials say."""

from dataclasses import replace

import numpy as np
import pytest
from made_up_floor import FLOOR
from numpy.typing import NDArray
from synthetic.rough_laser import RoughDrive, RoughLaser
from synthetic.settings import SceneSettings
from synthetic.world import scene

CLEAN = RoughLaser(
    noise_m=0.0, noise_per_m=0.0, step_m=0.001, missing=0.0, mixed=0.0, glass=0.0, tilt_rad=0.0
)
HERE, BEAMS = np.zeros(3), np.radians(np.linspace(-60.0, 60.0, 121))
WALL = np.array([[2.0, -4.0, 2.0, 4.0], [3.0, -8.0, 3.0, 8.0]])
CORNER = np.array([[2.0, 0.01, 2.0, 4.0], [3.0, -8.0, 3.0, 8.0]])


def measured(
    laser: RoughLaser, walls: NDArray[np.float64], glass: bool = False
) -> NDArray[np.float64]:
    generator = np.random.default_rng(1)
    drive = RoughDrive.of(laser, len(walls), np.zeros((1, 3)), generator)
    if glass:
        drive = replace(drive, glass=np.array([True, False]))
    return drive.ranges(0, walls, HERE, BEAMS, 8.0, generator)


def test_without_errors_it_measures_what_is_there() -> None:
    assert measured(CLEAN, WALL) == pytest.approx(2.0 / np.cos(BEAMS), abs=0.001)


def test_glass_is_seen_straight_ahead_and_through_aslant() -> None:
    seen = measured(CLEAN, WALL, glass=True)
    ahead = np.abs(BEAMS) < CLEAN.glass_within_rad - 0.01
    aslant = np.abs(BEAMS) > CLEAN.glass_within_rad + 0.01
    assert seen[ahead] == pytest.approx(2.0 / np.cos(BEAMS[ahead]), abs=0.001)
    assert seen[aslant] == pytest.approx(3.0 / np.cos(BEAMS[aslant]), abs=0.001)


def test_beams_at_an_edge_come_back_from_in_between() -> None:
    exact, mixed = measured(CLEAN, CORNER), measured(replace(CLEAN, mixed=1.0), CORNER)
    changed = np.flatnonzero(np.abs(exact - mixed) > 0.01)
    assert 0 < len(changed) < 4
    for each in changed:
        between = sorted((exact[each - 1], exact[each]))
        assert between[0] <= mixed[each] <= between[1]


def test_errors_grow_with_the_range() -> None:
    near, far = np.array([[1.0, -9.0, 1.0, 9.0]]), np.array([[3.5, -9.0, 3.5, 9.0]])
    laser = replace(CLEAN, noise_per_m=0.02)
    off = [np.std(measured(laser, each) * np.cos(BEAMS) - each[0, 0]) for each in (near, far)]
    assert off[1] > 2.0 * off[0]


def test_beams_that_point_down_end_at_the_floor() -> None:
    generator = np.random.default_rng(1)
    drive = RoughDrive(CLEAN, np.zeros(2, bool), np.radians([[10.0, 0.0]]))
    seen = drive.ranges(0, WALL, HERE, BEAMS, 8.0, generator)
    assert seen[60] == pytest.approx(CLEAN.height_m / np.radians(10.0), abs=0.01)


def test_what_is_black_is_not_seen() -> None:
    assert np.isinf(measured(replace(CLEAN, missing=1.0), WALL)).all()


def test_a_drive_with_it_is_the_same_for_the_same_seed() -> None:
    settings = SceneSettings(length_m=4.0, explained=0.6, people=1.0, rough=RoughLaser())
    one, same = (scene(FLOOR, settings, 4).log.steps for _ in range(2))
    assert all(np.array_equal(a.scan.ranges, b.scan.ranges) for a, b in zip(one, same, strict=True))
    plain = scene(FLOOR, replace(settings, rough=None), 4).log.steps
    assert not np.array_equal(one[3].scan.ranges, plain[3].scan.ranges)
