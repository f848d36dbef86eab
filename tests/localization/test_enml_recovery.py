"""Finding a lost robot: candidates, polishing, weighing, and not choosing where nothing tells."""

import numpy as np
import pytest

from mend.localization.distance_field import DistanceField, distance_field
from mend.localization.enml.anywhere import MODEL, Anywhere
from mend.localization.enml.episode import Episode
from mend.localization.enml.global_search import (
    GlobalSearch,
    Region,
    best_of_squares,
    distinct,
    score_places,
)
from mend.localization.enml.looks import Looks, glances, log_likelihoods, looks_of
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.polishing import GATES_M, polish
from mend.localization.enml.prior import whitening_of
from mend.localization.enml.recovery import Found, MayBeAt, Recovery
from mend.localization.enml.work import done
from mend.localization.points import scan_points
from mend.localization.pose import Poses, relative, transform, wrap_angle
from mend.localization.scan import Scan
from mend.maps.ray_cast import cast
from mend.maps.segment_grid import segment_grid
from mend.maps.vector_map import VectorMap

REACH_M = 12.0


def box(x0: float, y0: float, x1: float, y1: float) -> list[list[float]]:
    return [[x0, y0, x1, y0], [x1, y0, x1, y1], [x1, y1, x0, y1], [x0, y1, x0, y0]]


HERE = [*box(0, 0, 9, 6), [3, 0, 3, 2.5], [6.5, 6, 6.5, 4], *box(1, 4.5, 2, 5)]
ELSEWHERE = [*box(30, 0, 39, 6), [33, 6, 33, 3.5], [37, 0, 37, 2]]
FLOOR = VectorMap.of([*HERE, *ELSEWHERE])
TWINS = VectorMap.of([*HERE, *[[x0 + 30, y0, x1 + 30, y1] for x0, y0, x1, y1 in HERE]])
WAY = np.array([[2.0 + 0.4 * step, 3.2, 0.1 * step] for step in range(6)])


def field_of(vector_map: VectorMap) -> DistanceField:
    return distance_field(vector_map, 0.1, 1.0)


def recovery_on(vector_map: VectorMap, may_be_at: MayBeAt | None = None) -> Recovery:
    everywhere = Region(*vector_map.bounds)
    grid = segment_grid(vector_map.segments)
    anywhere = Anywhere(grid, everywhere)
    return Recovery(everywhere, field_of(vector_map), grid, anywhere, EnmlParameters(), may_be_at)


def search(
    recovery: Recovery,
    episode: Episode,
    followed: Episode | None,
    path_m: float,
    *,
    drifted: bool = False,
) -> Found | None:
    """All of a search, as many updates as it takes while the robot stands."""
    recovery.begin(episode, followed, path_m, drifted=drifted)
    found = None
    while recovery.is_searching:
        found = recovery.go_on()
    return found


def seen_along(way: Poses, vector_map: VectorMap, believed: Poses) -> Episode:
    """An episode of a robot on its way that believes to have begun elsewhere."""
    episode = Episode(EnmlParameters(), believed, whitening_of(np.eye(3)))
    angles = np.linspace(-2.2, 2.2, 151)
    for index, pose in enumerate(way):
        ranges, hit = cast(
            vector_map.segments, float(pose[0]), float(pose[1]), pose[2] + angles, REACH_M
        )
        scan = Scan(
            np.where(hit >= 0, ranges, np.inf), -2.2, float(angles[1] - angles[0]), REACH_M, index
        )
        motion = relative(way[index - 1], pose) if index else np.zeros(3)
        episode.extend(motion, scan, scan_points(scan))
    return episode


def off_m(found: Poses, pose: Poses) -> float:
    assert abs(wrap_angle(found[2] - pose[2])) < np.radians(3.0)
    return float(np.hypot(*(found - pose)[:2]))


def test_the_lattice_sums_how_well_all_points_fit() -> None:
    generator = np.random.default_rng(3)
    step, height, width, cell_m = 2, 9, 11, 0.1
    fit = generator.integers(0, 256, (height * step, width * step)).astype(np.uint8)
    phases = np.ascontiguousarray(fit.reshape(height, step, width, step).transpose(1, 3, 0, 2))
    points = generator.uniform(-1.0, 1.0, (20, 2))
    first = np.array([2, 1])
    for angle in (0.0, 1.0, 4.0):
        scores = np.zeros((4, 5), dtype=np.uint16)
        score_places(phases, first, cell_m, points, angle, scores)
        turned = transform(np.array([0.0, 0.0, angle]), points)
        cells = first + np.floor(turned / cell_m + 0.5).astype(int)
        for row in range(4):
            for column in range(5):
                at = cells + step * np.array([column, row])
                inside = ((at >= 0) & (at < [width * step, height * step])).all(axis=1)
                expected = int(fit[at[inside, 1], at[inside, 0]].astype(int).sum())
                assert scores[row, column] == expected


def test_of_each_square_of_places_the_best_is_kept() -> None:
    scores = np.random.default_rng(4).integers(1, 1000, (5, 8)).astype(np.uint16)
    squares, best = np.zeros((2, 3), dtype=np.uint16), np.zeros((2, 3), dtype=np.uint8)
    best_of_squares(scores, squares, best)
    for y in range(2):
        for x in range(3):
            square = scores[3 * y : 3 * y + 3, 3 * x : 3 * x + 3]
            assert squares[y, x] == square.max()
            row, column = divmod(int(best[y, x]), 3)
            assert square[row, column] == square.max()


def test_the_right_place_is_among_the_candidates() -> None:
    episode = seen_along(WAY, FLOOR, WAY[0])
    points = episode.nodes[-1].scan_points.points
    x_min, y_min, x_max, y_max = FLOOR.bounds
    found = done(
        GlobalSearch(field_of(FLOOR)).candidates(points, Region(x_min, y_min, x_max, y_max), 200)
    )
    away = [
        np.hypot(*(each - WAY[-1])[:2])
        for each in found
        if abs(wrap_angle(each[2] - WAY[-1][2])) < 0.1
    ]
    assert min(away) < 0.5


def test_nothing_seen_gives_no_candidates() -> None:
    region = Region(0.0, 0.0, 9.0, 6.0)
    assert len(done(GlobalSearch(field_of(FLOOR)).candidates(np.zeros((0, 2)), region, 10))) == 0


@pytest.mark.parametrize("off", [(0.4, -0.3, 0.08), (-0.3, 0.35, -0.1), (0.0, 0.0, 0.0)])
def test_polishing_brings_a_place_to_where_it_belongs(off: tuple[float, float, float]) -> None:
    episode = seen_along(WAY, FLOOR, WAY[0])
    places = np.array([WAY[-1] + np.array(off)])
    cos_max_angle = np.cos(EnmlParameters().max_angle_rad)
    grid = segment_grid(FLOOR.segments)
    polish(grid, looks_of(episode, 3), GATES_M, cos_max_angle, places)
    assert off_m(places[0], WAY[-1]) < 0.02


def test_the_right_place_weighs_more_than_one_that_is_off() -> None:
    looks: Looks = looks_of(seen_along(WAY, FLOOR, WAY[0]), 3)
    grid = segment_grid(FLOOR.segments)
    places = WAY[-1] + np.array([[0.0, 0.0, 0.0], [0.3, 0.2, 0.0], [28.0, 0.0, 1.0]])
    logs, merits = np.zeros(3), np.zeros(3)
    log_likelihoods(grid, looks, places, MODEL, logs)
    right, aside, elsewhere = logs
    assert right > aside + 5.0
    assert right > elsewhere + 20.0
    glances(grid, looks, places, merits)
    assert merits[0] > 0.9
    assert merits[2] < 0.6


def test_a_robot_is_found_wherever_it_believes_to_be() -> None:
    episode = seen_along(WAY, FLOOR, np.array([35.0, 3.0, 2.0]))
    found = search(recovery_on(FLOOR), episode, None, 2.0)
    assert found is not None
    assert off_m(found.pose, WAY[-1]) < 0.02
    assert found.score > EnmlParameters().found_above


def test_between_places_that_are_all_the_same_none_is_chosen() -> None:
    episode = seen_along(WAY, TWINS, np.array([20.0, 3.0, 0.0]))
    for path_m in (0.0, 2.0, 100.0):
        assert search(recovery_on(TWINS), episode, None, path_m) is None


def test_no_robot_is_found_where_none_can_be() -> None:
    episode = seen_along(WAY, TWINS, np.array([20.0, 3.0, 0.0]))
    recovery = recovery_on(TWINS, lambda x, _: x < 20.0)
    found = search(recovery, episode, None, 0.0)
    assert found is not None
    assert off_m(found.pose, WAY[-1]) < 0.02
    assert all(each.pose[0] < 20.0 for each in recovery.open_places(episode))
    assert search(recovery_on(TWINS, lambda *_: False), episode, None, 0.0) is None


def test_where_it_is_followed_a_robot_is_believed_although_another_place_is_hardly_worse() -> None:
    """The other room has its cupboard 0.15 m farther on, too little to be sure at first."""
    cupboard = box(31.15, 4.5, 32.15, 5)
    other = [[x0 + 30, y0, x1 + 30, y1] for x0, y0, x1, y1 in HERE[:-4]]
    alike = VectorMap.of([*HERE, *other, *cupboard])
    recovery = recovery_on(alike)
    lost = seen_along(WAY, alike, np.array([20.0, 3.0, 0.0]))
    assert search(recovery, lost, None, 0.0) is None
    recovery.forget()
    elsewhere = seen_along(WAY, alike, WAY[0] + np.array([30.0, 0.0, 0.0]))
    assert search(recovery, lost, elsewhere, 0.0) is None
    recovery.forget()
    found = search(recovery, lost, seen_along(WAY, alike, WAY[0]), 0.0)
    assert found is not None
    assert off_m(found.pose, WAY[-1]) < 0.02


def test_a_place_left_open_is_taken_once_it_is_clearly_better() -> None:
    recovery = recovery_on(TWINS)
    assert search(recovery, seen_along(WAY[:-1], TWINS, WAY[0]), None, 0.0) is None
    assert len(recovery.open_places(seen_along(WAY[:-1], TWINS, WAY[0]))) >= 2
    recovery.move(relative(WAY[-2], WAY[-1]))
    open_places = recovery.open_places(seen_along(WAY, TWINS, WAY[0]))
    assert min(np.hypot(*(each.pose - WAY[-1])[:2]) for each in open_places) < 0.05
    recovery.forget()
    assert recovery.open_places(seen_along(WAY, TWINS, WAY[0])) == []


def test_in_a_corridor_there_are_candidates_from_one_end_to_the_other() -> None:
    narrowing = VectorMap.of(
        [[0, -1.6, 30, -1.0], [0, 1.6, 30, 1.0], [0, -1.6, 0, 1.6], [30, -1.0, 30, 1.0]]
    )
    way = np.array([[9.0 + 0.4 * step, 0.0, 0.0] for step in range(4)])
    points = seen_along(way, narrowing, way[0]).nodes[-1].scan_points.points
    region = Region(0, -1.6, 30, 1.6)
    found = done(GlobalSearch(field_of(narrowing)).candidates(points, region, 200))
    ahead = [each[0] for each in found if abs(wrap_angle(each[2])) < 0.2 and abs(each[1]) < 0.7]
    for along_m in np.arange(2.0, 26.0, 0.5):
        assert min(np.abs(np.array(ahead) - along_m)) <= 0.8


def test_a_search_is_done_a_little_at_a_time_while_the_robot_drives_on() -> None:
    way = np.vstack([WAY, [[4.3, 3.2, 0.5], [4.6, 3.3, 0.6]]])
    recovery = recovery_on(FLOOR)
    recovery.begin(seen_along(WAY, FLOOR, WAY[0]), None, 2.0)
    assert recovery.go_on() is None
    recovery.move(relative(way[-3], way[-2]))
    recovery.move(relative(way[-2], way[-1]))
    found = None
    while recovery.is_searching:
        found = recovery.go_on()
    assert found is not None
    assert off_m(found.pose, way[-1]) < 0.02


def test_a_search_that_was_given_up_finds_nothing() -> None:
    recovery = recovery_on(FLOOR)
    recovery.begin(seen_along(WAY, FLOOR, WAY[0]), None, 2.0)
    recovery.stop()
    assert not recovery.is_searching
    assert recovery.go_on() is None


def test_who_has_drifted_off_is_sooner_found_near_by_than_elsewhere_and_in_two_searches() -> None:
    lost = seen_along(WAY, TWINS, np.array([20.0, 3.0, 0.0]))
    aside = seen_along(WAY, TWINS, WAY[0] + np.array([1.0, 0.6, 0.1]))
    carried, drifted = recovery_on(TWINS), recovery_on(TWINS)
    for _ in range(2):
        assert search(carried, lost, aside, 0.0) is None
    assert search(drifted, lost, aside, 0.0, drifted=True) is None
    found = search(drifted, lost, aside, 0.0, drifted=True)
    assert found is not None
    assert off_m(found.pose, WAY[-1]) < 0.02


def test_it_suspects_that_the_robot_is_elsewhere_where_it_cannot_say_in_which_of_two_places() -> (
    None
):
    recovery = recovery_on(TWINS)
    lost = seen_along(WAY, TWINS, np.array([20.0, 3.0, 0.0]))
    wrong = seen_along(WAY, TWINS, WAY[0] + np.array([4.0, 0.0, 2.0]))
    assert search(recovery, lost, wrong, 0.0, drifted=True) is None
    assert recovery.suspects_elsewhere
    right = seen_along(WAY, TWINS, WAY[0])
    search(recovery, lost, right, 0.0, drifted=True)
    assert not recovery.suspects_elsewhere


def test_on_an_empty_map_nobody_is_found() -> None:
    nothing = VectorMap.of([])
    assert search(recovery_on(nothing), seen_along(WAY, FLOOR, WAY[0]), None, 5.0) is None


def test_of_places_that_are_the_same_only_the_first_is_kept() -> None:
    places = np.array([[0.0, 0.0, 3.1], [0.3, 0.0, -3.1], [0.0, 0.0, 1.0], [2.0, 0.0, 3.1]])
    assert distinct(places) == [0, 2, 3]
    assert distinct(np.zeros((0, 3))) == []
