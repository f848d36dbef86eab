"""Whoever waits for an elevator sees its cabin, stands free of walls, and lets others out."""

import math
from itertools import combinations

import numpy as np
import pytest

from mend.maps.building.building import Building, Floor, FloorPlace, Lane
from mend.maps.building.cabin import CABIN_M, cabin_walls, stop_of, waiting_points
from mend.maps.building.clearance import clearance_m, distances_m, is_clear
from mend.maps.building.random_building import random_building

NEEDS_M = 0.3


@pytest.mark.parametrize("seed", range(8))
def test_who_waits_has_room_sees_the_cabin_and_is_outside_it(seed: int) -> None:
    building = Building(random_building(seed, 3, 5 + seed * 5))
    for elevator, each in building.document.elevators.items():
        for name in each.stops:
            floor, stop = building.floors[name], stop_of(building, elevator, name)
            points = waiting_points(floor, stop, NEEDS_M)
            assert points
            for point in points:
                assert clearance_m(point, stop, floor.wall_segments) >= NEEDS_M
                assert math.dist(point, stop) > CABIN_M + NEEDS_M
            assert all(math.dist(a, b) >= 2 * NEEDS_M for a, b in combinations(points, 2))


def test_who_waits_stands_beside_the_lane_where_there_is_room() -> None:
    floor = Floor(
        places={"stop": FloorPlace(x=0.0, y=0.0), "hall": FloorPlace(x=6.0, y=0.0)},
        lanes=(Lane(between=("stop", "hall")),),
        walls=((-2.0, -2.0, 7.0, -2.0), (-2.0, 2.0, 7.0, 2.0)),
    )
    best = waiting_points(floor, (0.0, 0.0), NEEDS_M)[0]
    lane = np.array([[0.0, 0.0, 6.0, 0.0]])
    assert distances_m(np.array([best]), lane)[0] > 0.5


@pytest.mark.parametrize("seed", range(4))
def test_who_comes_by_the_lane_gets_to_where_it_waits_past_the_cabin(seed: int) -> None:
    building = Building(random_building(seed, 2, 5 + seed * 5))
    for elevator, each in building.document.elevators.items():
        for name in each.stops:
            floor, stop = building.floors[name], stop_of(building, elevator, name)
            cabin = np.array([[*stop, *stop]])
            (lane,) = {e.between for e in floor.lanes if each.stops[name] in e.between}
            (end,) = (floor.places[e] for e in lane if e != each.stops[name])
            on_lane = np.linspace((end.x, end.y), stop, 200)
            for point in waiting_points(floor, stop, NEEDS_M):
                assert any(
                    clearance_m((x, y), point, cabin) > CABIN_M + NEEDS_M - 0.02
                    and clearance_m((x, y), point, floor.wall_segments) >= NEEDS_M - 0.02
                    for x, y in on_lane.tolist()
                )


def test_nobody_waits_behind_a_cabin_past_which_there_is_no_room() -> None:
    floor = Floor(
        places={"stop": FloorPlace(x=0.0, y=0.0), "hall": FloorPlace(x=6.0, y=0.0)},
        lanes=(Lane(between=("stop", "hall")),),
        walls=((-7.0, -1.3, 7.0, -1.3), (-7.0, 1.3, 7.0, 1.3)),
    )
    waits = [x for x, _ in waiting_points(floor, (0.0, 0.0), NEEDS_M)]
    assert len(waits) > 2
    assert min(waits) > 0.0
    alone = floor.model_copy(update={"lanes": ()})
    assert min(x for x, _ in waiting_points(alone, (0.0, 0.0), NEEDS_M)) < -1.0


def test_nobody_waits_where_walls_are_all_round() -> None:
    walls = cabin_walls((0.0, 0.0))
    floor = Floor(
        places={"stop": FloorPlace(x=0.0, y=0.0)}, walls=tuple(map(tuple, walls.tolist()))
    )
    assert waiting_points(floor, (0.0, 0.0), NEEDS_M) == ()


def test_the_walls_of_a_cabin_are_round_its_stop() -> None:
    walls = cabin_walls((3.0, -1.0))
    assert distances_m(np.array([[3.0, -1.0]]), walls)[0] == pytest.approx(CABIN_M)
    assert np.allclose(walls[:, 2:], np.roll(walls[:, :2], -1, axis=0))


def test_a_way_is_clear_of_what_keeps_as_far_from_it_as_it_needs() -> None:
    random = np.random.default_rng(5)
    told = set()
    for _ in range(100):
        walls = random.uniform(-5.0, 5.0, (random.integers(0, 12), 4))
        (x0, y0), (x1, y1) = random.uniform(-4.0, 4.0, (2, 2)).tolist()
        needs_m = float(random.choice((0.3, clearance_m((x0, y0), (x1, y1), walls))))
        clear = is_clear((x0, y0), (x1, y1), walls, needs_m)
        assert clear == (clearance_m((x0, y0), (x1, y1), walls) >= needs_m)
        told.add(clear)
    assert told == {True, False}


def test_where_lanes_come_from_both_sides_who_waits_stands_on_the_side_of_one() -> None:
    """A corridor too narrow to get past its cabin, with a niche behind that no lane leads to."""
    sides = {"stop": (0.0, 0.0), "left": (-6.0, 0.0), "right": (6.0, 0.0)}
    floor = Floor(
        places={name: FloorPlace(x=x, y=y) for name, (x, y) in sides.items()},
        lanes=(Lane(between=("stop", "left")), Lane(between=("stop", "right"))),
        walls=(
            (-7.0, -0.8, 7.0, -0.8),
            (-7.0, 0.8, -0.7, 0.8),
            (0.7, 0.8, 7.0, 0.8),
            (-0.7, 0.8, -0.7, 4.0),
            (0.7, 0.8, 0.7, 4.0),
        ),
    )
    waits = waiting_points(floor, (0.0, 0.0), NEEDS_M)
    assert {x > 0.0 for x, _ in waits} == {True, False}
    assert max(y for _, y in waits) < 0.8
