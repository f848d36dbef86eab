"""Made-up drives: the dials do what they say, and the same seed makes the same drive."""

import numpy as np
import pytest
from made_up_floor import FLOOR
from synthetic.settings import OdometrySettings, SceneSettings
from synthetic.world import scene

from mend.errors import WrongInputError
from mend.localization.pose import compose
from mend.maps.ray_cast import cast
from mend.maps.vector_map import VectorMap

SHORT = SceneSettings(length_m=6.0)


def test_on_a_static_floor_the_scans_show_the_map() -> None:
    made_up = scene(FLOOR, SHORT, seed=1)
    assert made_up.explained == 1.0
    assert len(made_up.furniture) == 0
    for pose, step in zip(made_up.truth[::20], made_up.log.steps[::20], strict=True):
        expected, hit = cast(FLOOR.segments, *pose[:2], pose[2] + step.scan.angles, 8.0)
        assert step.scan.ranges[hit >= 0] == pytest.approx(expected[hit >= 0], abs=0.12)


@pytest.mark.parametrize("explained", [0.7, 0.4])
def test_furniture_hides_the_map_as_far_as_was_asked_for(explained: float) -> None:
    made_up = scene(FLOOR, SceneSettings(length_m=6.0, explained=explained), seed=2)
    assert made_up.explained == pytest.approx(explained, abs=0.06)
    assert len(made_up.furniture) > 0


def test_nothing_stands_in_the_robots_way() -> None:
    made_up = scene(FLOOR, SceneSettings(length_m=6.0, explained=0.4), seed=2)
    around = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
    surroundings = np.vstack((made_up.walls, made_up.furniture))
    for pose in made_up.truth:
        ranges, _ = cast(surroundings, pose[0], pose[1], around, 8.0)
        assert ranges.min() > 0.2


def test_the_same_seed_makes_the_same_drive() -> None:
    settings = SceneSettings(length_m=4.0, explained=0.6, removed=0.2, people=2.0)
    one, same, other = (scene(FLOOR, settings, seed) for seed in (4, 4, 5))
    assert np.array_equal(one.truth, same.truth)
    assert np.array_equal(one.log.steps[3].scan.ranges, same.log.steps[3].scan.ranges)
    assert not np.array_equal(one.truth, other.truth)


def test_removed_walls_are_not_there_any_more() -> None:
    made_up = scene(FLOOR, SceneSettings(length_m=4.0, removed=0.5), seed=1)
    assert 0 < len(made_up.walls) < len(FLOOR)


def test_people_come_into_view_and_go() -> None:
    settings = SceneSettings(length_m=6.0, people=3.0)
    crowded, empty = scene(FLOOR, settings, seed=1), scene(FLOOR, SHORT, seed=1)
    nearer = [
        np.mean(a.scan.ranges < b.scan.ranges - 0.3)
        for a, b in zip(crowded.log.steps, empty.log.steps, strict=True)
    ]
    assert max(nearer) > 0.05
    assert min(nearer) < max(nearer)


def test_without_noise_odometry_leads_along_the_truth() -> None:
    exact = OdometrySettings(0.0, 0.0, 0.0, 0.0)
    made_up = scene(FLOOR, SceneSettings(length_m=4.0, odometry=exact), seed=1)
    pose = made_up.truth[0]
    for step in made_up.log.steps[1:]:
        pose = compose(pose, step.odometry)
    assert pose == pytest.approx(made_up.truth[-1], abs=1e-9)


@pytest.mark.parametrize(
    "wrong", [{"explained": 1.5}, {"removed": -0.1}, {"length_m": 0.0}, {"people": -1.0}]
)
def test_a_dial_off_its_scale_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        SceneSettings(**wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("rows", [[], [[0, 0, 5, 0]]])
def test_a_map_with_no_room_is_refused(rows: list[list[float]]) -> None:
    with pytest.raises(WrongInputError, match="no closed area"):
        scene(VectorMap.of(rows), SHORT, seed=1)
