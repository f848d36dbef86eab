"""From wherever a robot was pushed, a way leads to the lanes if there is one."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.maps.building.clearance import clearance_m, distances_m
from mend.maps.building.crossing import crossed_by
from mend.maps.building.floor_grid import Point
from mend.maps.building.random_building import random_building
from mend.maps.navigation import Place
from mend.robots.base.lane_access import nearest_access
from mend.robots.execution.command_error import CommandError

NEEDS_M = 0.3
NEAR, FAR = Place("near", 2.0, 0.0), Place("far", -5.0, 0.0)
CORNER = np.array([[1.0, -2.0, 1.0, 2.0], [-2.0, -2.0, -2.0, 9.0], [-2.0, -2.0, 1.0, -2.0]])
SHUT = np.concatenate([CORNER, [[-2.0, 9.0, 1.0, 9.0], [1.0, 9.0, 1.0, 2.0]]])
near = st.floats(-4.0, 4.0)


def test_what_is_straight_on_is_gone_to_though_something_behind_a_wall_is_nearer() -> None:
    found = nearest_access((0.0, 0.0), [NEAR, FAR], CORNER[:1], [], NEEDS_M)
    assert (found.place, found.corners) == (FAR, ())


def test_where_nothing_is_in_sight_a_way_leads_round_the_corner() -> None:
    found = nearest_access((0.0, 0.0), [NEAR, FAR], CORNER, [], NEEDS_M)
    assert found.place == NEAR
    way = [(0.0, 0.0), *found.corners, (2.0, 0.0)]
    assert 2 <= len(found.corners) <= 6
    assert sum(math.dist(a, b) for a, b in pairwise(way)) < 6.0
    assert all(clearance_m(a, b, CORNER) > NEEDS_M - 0.1 for a, b in pairwise(way))


def test_nobody_goes_through_a_cabin_to_get_round_a_corner() -> None:
    gap = np.concatenate([SHUT[:-1], [[1.0, 9.0, 1.0, 3.3]]])
    assert nearest_access((0.0, 0.0), [NEAR], gap, [(5.0, 2.65)], NEEDS_M).place == NEAR
    with pytest.raises(CommandError, match=r"no way leads from \(0.00, 0.00\) to a lane"):
        nearest_access((0.0, 0.0), [NEAR], gap, [(1.0, 2.65)], NEEDS_M)


def test_a_slit_that_nobody_fits_through_is_no_way_where_another_one_is() -> None:
    slit = np.array([[1.0, -9.0, 1.0, -0.1], [1.0, 0.1, 1.0, 4.0]])
    found = nearest_access((0.0, 0.0), [NEAR], slit, [], NEEDS_M)
    assert found.corners
    assert max(y for _, y in found.corners) > 4.0
    shut = np.concatenate([slit, [[1.0, 4.0, -9.0, 4.0], [-9.0, 4.0, -9.0, -9.0]]])
    shut = np.concatenate([shut, [[-9.0, -9.0, 1.0, -9.0]]])
    assert nearest_access((0.0, 0.0), [NEAR], shut, [], NEEDS_M).place == NEAR


def test_who_stands_near_a_wall_goes_straight_on_along_it() -> None:
    wall = np.array([[-3.0, -0.2, 3.0, -0.2]])
    assert nearest_access((0.0, 0.0), [NEAR], wall, [], NEEDS_M).corners == ()


def test_a_cabin_is_gone_to_where_there_is_nothing_else() -> None:
    assert nearest_access((0.0, 0.0), [NEAR], CORNER[1:], [(2.0, 0.0)], NEEDS_M).place == NEAR
    found = nearest_access((0.0, 0.0), [NEAR, FAR], CORNER[2:], [(2.0, 0.0)], NEEDS_M)
    assert found.place == FAR


def test_who_is_shut_in_is_told_so() -> None:
    with pytest.raises(CommandError, match="no way leads from"):
        nearest_access((0.0, 0.0), [NEAR, FAR], SHUT, [], NEEDS_M)
    with pytest.raises(CommandError, match="no way leads from"):
        nearest_access((0.0, 0.0), [], CORNER, [], NEEDS_M)


@given(st.lists(st.tuples(near, near, near, near), max_size=6), st.tuples(near, near))
def test_no_way_to_a_lane_leads_through_a_wall(
    around: list[tuple[float, float, float, float]], at: Point
) -> None:
    walls = np.array(around, np.float64).reshape(-1, 4)
    try:
        found = nearest_access((0.0, 0.0), [Place("goal", *at)], walls, [], NEEDS_M)
    except CommandError:
        return
    for a, b in pairwise([(0.0, 0.0), *found.corners, at]):
        assert not len(crossed_by(np.array([*a, *b]), walls))


@pytest.mark.parametrize("seed", range(4))
def test_a_way_leads_to_the_lanes_from_all_over_a_floor(seed: int) -> None:
    """Whoever has room to stand in sight of a lane is not shut in."""
    building = random_building(seed, 1, 12)
    (floor,) = building.floors.values()
    walls = np.array(floor.walls)
    places = [Place(name, each.x, each.y) for name, each in floor.places.items()]
    generator = np.random.default_rng(seed)
    for lane in floor.lanes:
        (ax, ay), (bx, by) = ((floor.places[e].x, floor.places[e].y) for e in lane.between)
        share, turn = generator.uniform(0.0, 1.0), generator.uniform(0.0, math.tau)
        off_m = generator.uniform(0.0, 2.5)
        on = ax + share * (bx - ax), ay + share * (by - ay)
        at = on[0] + off_m * math.cos(turn), on[1] + off_m * math.sin(turn)
        if len(crossed_by(np.array([*on, *at]), walls)):
            continue
        if distances_m(np.array([at]), walls)[0] < NEEDS_M:
            continue
        found = nearest_access(at, places, walls, [], NEEDS_M)
        goal = found.place.x_m, found.place.y_m
        for a, b in pairwise([at, *found.corners, goal]):
            assert not len(crossed_by(np.array([*a, *b]), walls))
