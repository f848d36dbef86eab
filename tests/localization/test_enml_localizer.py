"""Episodic non-Markov localization: it follows, it tells what is what, and it knows when not."""

from dataclasses import replace

import numpy as np
import plain_normal_equations
import pytest
from sampled import sample

from mend.localization.enml.localizer import EnmlLocalizer
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.localizer import Estimate, PointClass
from mend.localization.pose import Poses, compose, relative, wrap_angle
from mend.localization.scan import InvalidScanError, Scan
from mend.maps.ray_cast import cast
from mend.maps.vector_map import VectorMap

BEAMS = 181
RANGE_M = 12.0


def box(x0: float, y0: float, x1: float, y1: float) -> list[list[float]]:
    return [[x0, y0, x1, y0], [x1, y0, x1, y1], [x1, y1, x0, y1], [x0, y1, x0, y0]]


FLOOR = VectorMap.of(
    [
        *box(0.0, 0.0, 16.0, 10.0),
        [6.0, 0.0, 6.0, 4.0],
        [6.0, 6.0, 6.0, 10.0],
        [11.0, 3.0, 16.0, 3.0],
        *box(2.0, 7.5, 3.0, 8.5),
        *box(12.0, 6.0, 12.5, 8.0),
    ]
)
FURNITURE = np.array([*box(3.0, 1.2, 3.6, 1.8), *box(8.0, 6.6, 9.0, 7.4), *box(9.0, 2.0, 9.5, 2.6)])
NOTHING = {
    "not numbers": np.full(BEAMS, np.nan),
    "zeros": np.zeros(BEAMS),
    "infinite": np.full(BEAMS, np.inf),
    "out of range": np.full(BEAMS, RANGE_M),
    "negative": np.full(BEAMS, -1.0),
    "covered": 0.2 + 0.1 * np.sin(0.1 * np.arange(BEAMS)),
}
OUTSIDE = np.array([-40.0, -40.0, 0.0])


def way(count: int) -> Poses:
    """From room to room, 0.15 m a step."""
    x = 1.5 + 0.15 * np.arange(count)
    y = 5.0 + 0.4 * np.sin(0.6 * x)
    heading = np.arctan2(np.gradient(y), np.gradient(x))
    return np.column_stack([x, y, heading])


def seen_from(
    pose: Poses, time_s: float, generator: np.random.Generator, world: np.ndarray
) -> Scan:
    angles = np.linspace(-0.75 * np.pi, 0.75 * np.pi, BEAMS)
    ranges, hit = cast(world, float(pose[0]), float(pose[1]), pose[2] + angles, RANGE_M)
    noisy = np.where(hit >= 0, ranges + generator.normal(0.0, 0.01, BEAMS), np.inf)
    return Scan(noisy, float(angles[0]), float(angles[1] - angles[0]), RANGE_M, time_s)


def drive(poses: Poses, seed: int = 0, world: np.ndarray | None = None) -> list[tuple[Poses, Scan]]:
    """Motions with noise and what is seen after each."""
    generator = np.random.default_rng(seed)
    if world is None:
        world = np.vstack([FLOOR.segments, FURNITURE])
    motions = np.vstack([np.zeros((1, 3)), relative(poses[:-1], poses[1:])])
    motions[1:] += generator.normal(0.0, [0.01, 0.01, 0.01], (len(poses) - 1, 3))
    return [
        (motion, seen_from(pose, 0.1 * index, generator, world))
        for index, (motion, pose) in enumerate(zip(motions, poses, strict=True))
    ]


def off(estimate: Estimate, pose: Poses) -> tuple[float, float]:
    """Metres and radians."""
    away = float(np.hypot(*(estimate.pose - pose)[:2]))
    return away, abs(wrap_angle(estimate.pose[2] - pose[2]))


def blind(ranges: np.ndarray, time_s: float = 0.0) -> Scan:
    return Scan(ranges, -np.pi / 2, np.pi / 180, RANGE_M, time_s)


@pytest.mark.slow
def test_it_follows_the_robot_through_furniture_and_tells_what_is_what() -> None:
    poses = way(60)
    localizer = EnmlLocalizer(FLOOR, start=poses[0])
    estimates = [localizer.update(*step) for step in drive(poses)]
    errors = [off(*each) for each in zip(estimates, poses, strict=True)]
    assert max(away for away, _ in errors) < 0.1
    assert np.median([away for away, _ in errors]) < 0.02
    assert max(turned for _, turned in errors) < np.radians(2.0)
    assert not any(each.is_lost for each in estimates)
    assert max(each.lost for each in estimates) < 0.3
    newest = estimates[-1]
    # Where points belong is known exactly here: walls are long-term, boxes short-term.
    place = poses[-1]
    c, s = np.cos(place[2]), np.sin(place[2])
    points = newest.points.points @ np.array([[c, s], [-s, c]]) + place[:2]
    in_a_box = np.zeros(len(points), dtype=bool)
    for x0, y0, x1, y1 in ((3.0, 1.2, 3.6, 1.8), (8.0, 6.6, 9.0, 7.4), (9.0, 2.0, 9.5, 2.6)):
        low, high = np.array([x0, y0]) - 0.06, np.array([x1, y1]) + 0.06
        in_a_box |= ((points >= low) & (points <= high)).all(axis=1)
    assert in_a_box.any()
    assert (newest.classes[in_a_box] == PointClass.STF).mean() > 0.7
    assert (newest.classes[~in_a_box] == PointClass.LTF).mean() > 0.9


def test_the_same_drive_gives_the_same_estimates() -> None:
    poses = way(12)
    steps = drive(poses)
    one, other = (EnmlLocalizer(FLOOR, start=poses[0]) for _ in range(2))
    for step in steps:
        a, b = one.update(*step), other.update(*step)
        np.testing.assert_array_equal(a.pose, b.pose)
        np.testing.assert_array_equal(a.covariance, b.covariance)
        np.testing.assert_array_equal(a.classes, b.classes)


def test_plain_numpy_gives_the_same_estimates() -> None:
    poses = way(12)
    steps = drive(poses)
    fast = EnmlLocalizer(FLOOR, start=poses[0])
    plain = EnmlLocalizer(FLOOR, start=poses[0], linearize=plain_normal_equations.linearize)
    for step in steps:
        np.testing.assert_allclose(
            fast.update(*step).pose, plain.update(*step).pose, rtol=0.0, atol=1e-6
        )


def test_a_reset_begins_anew() -> None:
    poses = way(12)
    steps = drive(poses)
    fresh, used = (EnmlLocalizer(FLOOR, start=poses[0]) for _ in range(2))
    for step in steps:
        used.update(*step)
    used.reset(poses[0])
    for step in steps:
        np.testing.assert_array_equal(fresh.update(*step).pose, used.update(*step).pose)


def test_an_episode_never_grows_past_its_maximum() -> None:
    poses = way(60)
    parameters = EnmlParameters(min_episode_length=4, max_episode_length=8)
    localizer = EnmlLocalizer(FLOOR, start=poses[0], parameters=parameters)
    for step in drive(poses):
        localizer.update(*step)
        assert len(localizer.episode_poses) <= 8


@pytest.mark.slow
def test_a_slip_of_the_wheels_does_not_mislead() -> None:
    poses = way(30)
    steps = drive(poses)
    motion, scan = steps[15]
    steps[15] = (motion + np.array([0.3, 0.0, np.radians(8.0)]), scan)
    localizer = EnmlLocalizer(FLOOR, start=poses[0])
    for step, pose in zip(steps, poses, strict=True):
        away, turned = off(localizer.update(*step), pose)
        assert away < 0.1
        assert turned < np.radians(3.0)


@pytest.mark.slow
@pytest.mark.parametrize("covered", [0, 6])
def test_a_kidnapped_robot_says_so_and_finds_itself_again(covered: int) -> None:
    poses = way(60)
    elsewhere = way(60)[::-1] + np.array([4.0, 0.5, np.pi])
    before, after = drive(poses[:20]), drive(elsewhere, seed=1)
    localizer = EnmlLocalizer(FLOOR, start=poses[0])
    for step in before:
        localizer.update(*step)
    for index in range(covered):
        localizer.update(
            np.zeros(3), replace(before[0][1], ranges=NOTHING["covered"], time_s=50 + index)
        )
    told, found = False, False
    for index, ((motion, scan), pose) in enumerate(zip(after, elsewhere, strict=True)):
        estimate = localizer.update(motion, replace(scan, time_s=100.0 + index))
        told |= estimate.is_lost
        found = not estimate.is_lost and off(estimate, pose)[0] < 0.2
    assert told
    assert found


def shelves(x0: float, depth: float) -> list[list[float]]:
    """Along both walls of a hall that is 3 m wide, from some place on."""
    return [
        side
        for x in x0 + 0.2 + 2.1 * np.arange(9)
        for corners in ((x, 0.05, x + 0.4, depth), (x + 0.9, 3.0 - depth, x + 1.3, 2.95))
        for side in box(*corners)
    ]


@pytest.mark.parametrize("put_m", sample([2.1], [2.1, 2.9]))
def test_in_the_copy_of_a_hall_a_robot_notices_by_the_furniture_that_it_was_carried(
    put_m: float,
) -> None:
    halls = [*box(0, 0, 20, 3), *box(40, 0, 60, 3)]
    localizer = EnmlLocalizer(VectorMap.of(halls), start=np.array([4.0, 1.5, 0.0]))
    world = np.array([*halls, *shelves(0.0, 0.22), *shelves(40.0, 0.42)])
    here = np.column_stack([np.arange(4.0, 8.0, 0.1), np.full(40, 1.5), np.zeros(40)])
    there = here + np.array([40.0 + put_m, 0.0, 0.0])
    before = [localizer.update(*step).is_lost for step in drive(here, 0, world)]
    after = [
        localizer.update(motion, replace(scan, time_s=100.0 + index)).is_lost
        for index, (motion, scan) in enumerate(drive(there, 9, world))
    ]
    assert not any(before)
    assert any(after[:4])


def test_beside_a_wall_that_is_gone_a_robot_is_followed_and_not_lost() -> None:
    niche = [[6, 0, 6, -2], [7.4, 0, 7.4, -2], [6, -2, 7.4, -2]]
    rest = [
        [0, 0, 6, 0], [7.4, 0, 16, 0], [16, 0, 16, 6], [16, 6, 0, 6], [0, 6, 0, 0],
        [3, 6, 3, 4], *box(1, 4.8, 2, 5.4), [10, 6, 10, 4.5], *box(12, 4.9, 13.5, 5.5),
    ]  # fmt: skip
    along = np.column_stack([np.arange(1.5, 10.0, 0.1), np.full(85, 0.7), np.zeros(85)])
    localizer = EnmlLocalizer(VectorMap.of([*rest, [6, 0, 7.4, 0]]), start=along[0])
    seen = drive(along, world=np.array([*rest, *niche], dtype=np.float64))
    estimates = [localizer.update(motion, scan) for motion, scan in seen]
    assert max(off(*each)[0] for each in zip(estimates, along, strict=True)) < 0.05
    assert not any(each.is_lost for each in estimates)


@pytest.mark.slow
def test_a_robot_that_starts_anywhere_says_that_it_is_lost_until_it_finds_itself() -> None:
    poses = way(40)
    localizer = EnmlLocalizer(FLOOR, start=poses[0])
    localizer.reset(np.zeros(3), np.diag([100.0, 100.0, 10.0]))
    estimates = [localizer.update(*step) for step in drive(poses)]
    assert estimates[0].is_lost
    assert not estimates[-1].is_lost
    assert off(estimates[-1], poses[-1])[0] < 0.1
    for estimate, pose in zip(estimates, poses, strict=True):
        assert estimate.is_lost or off(estimate, pose)[0] < 0.5


@pytest.mark.parametrize("ranges", NOTHING.values(), ids=NOTHING)
def test_scans_that_show_nothing_leave_odometry_and_raise_the_measure(ranges: np.ndarray) -> None:
    start = np.array([1.5, 5.0, 0.0])
    localizer = EnmlLocalizer(FLOOR, start=start)
    motion = np.array([0.2, 0.0, 0.1])
    for index in range(5):
        estimate = localizer.update(motion if index else np.zeros(3), blind(ranges, index))
    expected = start
    for _ in range(4):
        expected = compose(expected, motion)
    np.testing.assert_allclose(estimate.pose, expected, atol=1e-6)
    assert estimate.lost > 0.5
    assert len(estimate.classes) == 0
    assert np.isfinite(estimate.covariance).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", NOTHING)
def test_whoever_sees_nothing_on_the_way_is_in_doubt_until_something_is_seen_again(
    name: str,
) -> None:
    poses = way(60)
    localizer = EnmlLocalizer(FLOOR, start=poses[0])
    steps = drive(poses)
    steps[20:55] = [(motion, replace(scan, ranges=NOTHING[name])) for motion, scan in steps[20:55]]
    driven_m = np.cumsum([np.hypot(motion[0], motion[1]) for motion, _ in steps])
    measures = []
    for index, step in enumerate(steps):
        estimate = localizer.update(*step)
        assert off(estimate, poses[index])[0] < 0.6
        measures.append(estimate.lost)
        too_long = driven_m[index] - driven_m[20] >= EnmlParameters().blind_for_m
        assert estimate.is_lost == (too_long and index < 55)
    assert driven_m[54] - driven_m[20] > EnmlParameters().blind_for_m
    assert max(measures[:20]) < 0.2
    assert min(measures[20:55]) >= 0.5
    assert np.all(np.diff(measures[20:55]) > 0.0)
    assert max(measures[55:]) < 0.2
    assert off(estimate, poses[-1])[0] < 0.1


def test_a_laser_of_few_beams_is_not_blind() -> None:
    poses = way(20)
    localizer = EnmlLocalizer(FLOOR, start=poses[0])
    for motion, scan in drive(poses):
        few = replace(scan, ranges=scan.ranges[::30], angle_increment=30.0 * scan.angle_increment)
        estimate = localizer.update(motion, few)
    assert len(estimate.classes) < 10
    assert estimate.lost < 0.5
    assert not estimate.is_lost


def test_a_few_bad_ranges_among_good_ones_do_no_harm() -> None:
    poses = way(10)
    localizer = EnmlLocalizer(FLOOR, start=poses[0])
    generator = np.random.default_rng(5)
    for motion, scan in drive(poses):
        ranges = scan.ranges.copy()
        ranges[generator.integers(0, BEAMS, 40)] = np.nan
        ranges[generator.integers(0, BEAMS, 20)] = 0.0
        estimate = localizer.update(motion, replace(scan, ranges=ranges))
    assert off(estimate, poses[-1])[0] < 0.1


def test_what_cannot_follow_is_refused_and_changes_nothing() -> None:
    poses = way(8)
    steps = drive(poses)
    fresh, bothered = (EnmlLocalizer(FLOOR, start=poses[0]) for _ in range(2))
    for step in steps[:4]:
        fresh.update(*step)
        bothered.update(*step)
    motion, scan = steps[4]
    for bad_motion, bad_scan in (
        (motion, replace(scan, time_s=0.0)),
        (motion, replace(scan, ranges=scan.ranges[:90])),
        (np.array([np.nan, 0.0, 0.0]), scan),
    ):
        with pytest.raises(InvalidScanError):
            bothered.update(bad_motion, bad_scan)
    for step in steps[4:]:
        np.testing.assert_array_equal(fresh.update(*step).pose, bothered.update(*step).pose)


def test_on_an_empty_map_a_robot_is_lost_and_does_not_jump() -> None:
    poses = way(8)
    localizer = EnmlLocalizer(VectorMap.of([]), start=poses[0])
    for step in drive(poses):
        estimate = localizer.update(*step)
        assert estimate.is_lost
        assert estimate.lost == 1.0
    np.testing.assert_allclose(estimate.pose, poses[-1], atol=0.1)


@pytest.mark.slow
def test_a_robot_that_is_believed_outside_of_the_map_says_so_and_is_found() -> None:
    poses = way(60)
    localizer = EnmlLocalizer(FLOOR, start=OUTSIDE)
    estimates = [localizer.update(*step) for step in drive(poses)]
    silent = [
        off(estimate, pose)[0] > 1.0 and not estimate.is_lost
        for estimate, pose in zip(estimates, poses, strict=True)
    ]
    assert sum(silent) < 15
    assert not estimates[-1].is_lost
    assert off(estimates[-1], poses[-1])[0] < 0.1


YARD = np.array([*box(-1.0, -30.0, 17.0, -1.0), *box(4.0, -12.0, 5.0, -11.0)])


def out_into_the_yard(metres: float) -> Poses:
    """Through a gap in the south wall, and on where the map shows nothing ahead."""
    y = 4.0 - 0.15 * np.arange(round(metres / 0.15))
    x = 8.0 + 0.3 * np.sin(0.5 * y)
    return np.column_stack([x, y, np.arctan2(np.gradient(y), np.gradient(x))])


@pytest.mark.slow
def test_who_drives_on_where_the_map_shows_nothing_is_followed_by_what_is_seen_twice() -> None:
    gap = np.array([7.0, 9.0])
    south = [[0.0, 0.0, gap[0], 0.0], [gap[1], 0.0, 16.0, 0.0]]
    rest = FLOOR.segments[(FLOOR.segments[:, 1] > 0.0) | (FLOOR.segments[:, 3] > 0.0)]
    known = VectorMap.of(np.vstack([rest, south]))
    world = np.vstack([known.segments, FURNITURE, YARD[[0, 1, 3, 4, 5, 6, 7]]])
    poses = out_into_the_yard(20.0)
    localizer = EnmlLocalizer(known, start=poses[0])
    estimates = [localizer.update(*step) for step in drive(poses, world=world)]
    assert max(off(*each)[0] for each in zip(estimates, poses, strict=True)) < 0.5
    assert not any(each.is_lost for each in estimates)


@pytest.mark.parametrize(
    "wrong",
    [
        {"laser_std_m": 0.0},
        {"odometry_rate": float("nan")},
        {"min_episode_length": 1},
        {"max_episode_length": 5},
        {"max_angle_rad": 2.0},
    ],
)
def test_parameters_that_make_no_sense_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        EnmlParameters(**wrong)
