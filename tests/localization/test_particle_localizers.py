"""The two localizers with particles: good on a mapped floor, honest on nonsense, repeatable."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from made_up_floor import FLOOR
from synthetic.settings import SceneSettings
from synthetic.world import Scene, scene

from mend.errors import WrongInputError
from mend.localization.cgr.localizer import CgrLocalizer
from mend.localization.distance_field import distance_field
from mend.localization.evaluation import Trace, follow, summarize
from mend.localization.localizer import Localizer, PointClass
from mend.localization.mcl.localizer import MclLocalizer
from mend.localization.scan import InvalidScanError, Scan
from mend.maps.vector_map import VectorMap

Make = Callable[[VectorMap, int], Localizer]


def _mcl(vector_map: VectorMap, seed: int) -> Localizer:
    return MclLocalizer(vector_map, seed=seed)


def _cgr(vector_map: VectorMap, seed: int) -> Localizer:
    return CgrLocalizer(vector_map, seed=seed)


both = pytest.mark.parametrize("make", [_mcl, _cgr], ids=["mcl", "cgr"])


@cache
def _drive() -> Scene:
    return scene(FLOOR, SceneSettings(length_m=15.0), seed=3)


def _followed(localizer: Localizer, made_up: Scene) -> Trace:
    localizer.reset(made_up.truth[0])
    return follow(localizer, made_up.log)


@pytest.mark.slow
@both
def test_on_a_mapped_floor_it_is_never_lost(make: Make) -> None:
    made_up = _drive()
    trace = _followed(make(FLOOR, 1), made_up)
    summary = summarize(trace, made_up.log)
    assert summary.lost_events == 0
    assert summary.median_error_m is not None
    assert summary.median_error_m < 0.04
    assert not trace.said_lost.any()


@both
def test_the_same_seed_gives_the_same_estimates(make: Make) -> None:
    steps = _drive().log.steps[:10]
    told = []
    for seed in (1, 1, 2):
        localizer = make(FLOOR, seed)
        localizer.reset(_drive().truth[0])
        told.append([localizer.update(each.odometry, each.scan).pose for each in steps])
    assert np.array_equal(told[0], told[1])
    assert not np.array_equal(told[0], told[2])


@both
def test_points_on_no_wall_of_the_map_are_not_put_down_to_it(make: Make) -> None:
    localizer = make(FLOOR, 1)
    step = _drive().log.steps[0]
    localizer.reset(_drive().truth[0])
    ranges = step.scan.ranges.copy()
    ranges[100:130] = 0.3
    scan = Scan(ranges, step.scan.angle_min, step.scan.angle_increment, 8.0)
    estimate = localizer.update(step.odometry, scan)
    near = np.isin(estimate.points.beams, np.arange(100, 130))
    assert np.mean(estimate.classes[near] == PointClass.DF) > 0.8
    assert np.mean(estimate.classes[~near] == PointClass.LTF) > 0.8


@both
@pytest.mark.parametrize("ranges", [np.full(90, np.nan), np.zeros(90), np.full(90, np.inf)])
def test_blind_it_goes_by_odometry_and_says_that_it_gets_lost(
    make: Make, ranges: np.ndarray
) -> None:
    localizer = make(FLOOR, 1)
    localizer.reset(np.array([12.0, 7.0, 0.0]))
    for number in range(8):
        scan = Scan(ranges, -1.5, 0.03, 8.0, float(number))
        estimate = localizer.update(np.array([0.1, 0.0, 0.0]), scan)
    assert estimate.pose[:2] == pytest.approx([12.8, 7.0], abs=0.2)
    assert estimate.is_lost
    assert len(estimate.points) == 0


@both
@pytest.mark.parametrize(
    ("vector_map", "start"),
    [(VectorMap.of([]), (0.0, 0.0, 0.0)), (FLOOR, (500.0, -500.0, 1.0))],
    ids=["empty map", "far outside"],
)
def test_where_the_map_shows_nothing_it_is_lost(
    make: Make, vector_map: VectorMap, start: tuple[float, float, float]
) -> None:
    localizer = make(vector_map, 1)
    localizer.reset(np.array(start))
    for number in range(8):
        scan = Scan(np.full(90, 3.0), -1.5, 0.03, 8.0, float(number))
        estimate = localizer.update(np.array([0.1, 0.0, 0.0]), scan)
    assert np.isfinite(estimate.pose).all()
    assert estimate.is_lost
    assert np.hypot(*(estimate.pose[:2] - start[:2])) < 1.5


@both
def test_a_refused_scan_changes_nothing(make: Make) -> None:
    steps = _drive().log.steps
    told = []
    for disturbed in (False, True):
        localizer = make(FLOOR, 1)
        localizer.reset(_drive().truth[0])
        localizer.update(steps[0].odometry, steps[0].scan)
        if disturbed:
            with pytest.raises(InvalidScanError):
                localizer.update(np.array([5.0, 0, 0]), Scan(np.ones(7), 0.0, 0.1, 8.0, 1.0))
        told.append(localizer.update(steps[1].odometry, steps[1].scan).pose)
    assert np.array_equal(told[0], told[1])


def test_the_distance_field_is_the_distance() -> None:
    field = distance_field(FLOOR, 0.05, 1.0)
    generator = np.random.default_rng(2)
    points = generator.uniform((-2, -2), (26, 16), (200, 2))
    start, edge = FLOOR.segments[:, :2], FLOOR.segments[:, 2:] - FLOOR.segments[:, :2]
    along = ((points[:, None] - start) * edge).sum(axis=2) / (edge * edge).sum(axis=1)
    nearest = start + np.clip(along, 0, 1)[..., None] * edge
    away = np.hypot(*(points[:, None] - nearest).transpose(2, 0, 1)).min(axis=1)
    assert field.at(points) == pytest.approx(np.minimum(away, 1.0), abs=0.03)


def test_a_map_too_large_for_a_field_says_so() -> None:
    with pytest.raises(WrongInputError, match="too large for a likelihood field"):
        MclLocalizer(VectorMap.of([[0, 0, 9e3, 9e3]]))
