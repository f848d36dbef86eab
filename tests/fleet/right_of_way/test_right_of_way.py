"""Of two robots that meet one makes way: to where the other one can pass it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.fleet.right_of_way.right_of_way import (
    AGAIN_S,
    APART_M,
    FORGET_S,
    MOST_TIMES,
    WALL_M,
    RightOfWay,
    Standing,
)
from mend.maps.building.building import Building, BuildingDocument, Door, Floor, FloorPlace, Lane
from mend.maps.building.clearance import distances_m
from mend.maps.building.floor_grid import Point, sampled
from mend.maps.building.random_building import random_building

BASE = RADIUS_M, SPEED_M_S = 0.25, 1.0
CELL_M = 0.1
POSTS = ((5.0, 1.55), (5.0, 2.45))


def two_rooms(*walls: tuple[float, float, float, float]) -> Building:
    """Two rooms of 5 x 4 m side by side, with a door between them at (5, 2)."""
    around = ((0, 0, 10, 0), (0, 4, 10, 4), (0, 0, 0, 4), (10, 0, 10, 4))
    between = ((5, 0, *POSTS[0]), (*POSTS[1], 5, 4))
    floor = Floor(
        places={"left": FloorPlace(x=2, y=2), "right": FloorPlace(x=8, y=2)},
        lanes=(Lane(between=("left", "right")),),
        walls=(*around, *between, *walls),
        doors={"door": Door(posts=POSTS)},
    )
    return Building(BuildingDocument(building="rooms", floors={"F1": floor}))


def right_of_way(building: Building | None = None) -> RightOfWay:
    return RightOfWay(building or two_rooms())


def at(x: float, *way: Point, y: float = 2.0, barred: bool = True) -> Standing:
    """Somebody who drives."""
    return Standing("F1", (x, y), *BASE, [(x, y), *way], may_move=True, barred=barred)


EAST, WEST = (8.0, 2.0), (2.0, 2.0)
MET = {"ada": at(4.6, EAST), "bob": at(5.4, WEST)}


def test_one_of_two_that_meet_in_a_door_makes_way_once() -> None:
    decided = right_of_way().decide(MET, 7.0)
    assert decided is not None
    assert {decided.robot, decided.other} == {"ada", "bob"}
    assert decided.until_s > 7.0
    same = right_of_way()
    assert same.decide(MET, 7.0) == decided
    assert same.decide(MET, 7.5) is None
    assert same.decide(MET, decided.until_s + 1.0) is not None


def test_who_has_the_shorter_way_to_a_bay_takes_it() -> None:
    tight = two_rooms((0.0, 1.5, 4.7, 1.5), (0.0, 2.5, 4.7, 2.5))
    decided = right_of_way(tight).decide(MET, 0.0)
    assert decided is not None
    assert decided.robot == "bob"


def test_who_has_somebody_behind_it_does_not_make_way() -> None:
    for behind, waits in (("ada", at(3.9, EAST)), ("bob", at(6.1, WEST))):
        walls = [(x0, y, x0 + 3.8, y) for x0 in (0.6, 5.6) for y in (1.5, 2.5)]
        decided = right_of_way(two_rooms(*walls)).decide({**MET, "carl": waits}, 0.0)
        assert decided is not None
        assert decided.robot not in (behind, "carl")


def test_who_makes_way_already_goes_before_who_stands_behind_it() -> None:
    rights = right_of_way()
    first = rights.decide(MET, 0.0)
    assert first is not None
    (x, y), other = first.way[-1], MET[first.robot]
    ahead = first.way[0][0] - other.at[0], first.way[0][1] - other.at[1]
    scale = 0.75 / math.hypot(*ahead)
    behind = other.at[0] + scale * ahead[0], other.at[1] + scale * ahead[1]
    makes = replace(other, way=[other.at, *first.way, (x, y)])
    comes = Standing("F1", behind, *BASE, [behind, other.at], may_move=True)
    standings = {**MET, first.robot: makes, "carl": comes}
    decided = rights.decide(standings, 1.0)
    assert decided is not None
    assert (decided.robot, decided.other) == ("carl", first.robot)


@pytest.mark.parametrize(
    "changed",
    [
        {"ada": at(4.6, EAST, barred=False), "bob": at(5.4, WEST, barred=False)},
        {"ada": at(4.6, EAST), "bob": at(7.0, WEST)},
        {"ada": at(4.6, EAST), "bob": at(5.4, EAST, barred=False)},
        {"ada": at(4.6, EAST), "bob": replace(at(5.4, WEST), floor="F2")},
        {"ada": at(4.6, EAST)},
    ],
    ids=["both get on", "far apart", "one follows the other", "another floor", "alone"],
)
def test_who_has_not_met_anybody_goes_on(changed: dict[str, Standing]) -> None:
    assert right_of_way().decide(changed, 0.0) is None


@pytest.mark.parametrize("radius_m", [0.2, 0.3, 0.38])
def test_a_wide_robot_needs_a_bay_that_is_farther_off_the_way(radius_m: float) -> None:
    asks = replace(MET["bob"], may_move=False)
    makes = replace(MET["ada"], radius_m=radius_m)
    decided = right_of_way().decide({"ada": makes, "bob": asks}, 0.0)
    assert decided is not None
    assert decided.robot == "ada"
    off_m = np.hypot(*(sampled(asks.way) - np.array(decided.way[-1])).T).min()
    assert off_m >= RADIUS_M + radius_m + APART_M - 1.5 * CELL_M


def test_a_slow_robot_is_waited_for_longer() -> None:
    decided = right_of_way().decide(MET, 0.0)
    assert decided is not None
    slow = {name: replace(each, speed_m_s=0.25) for name, each in MET.items()}
    again = right_of_way().decide(slow, 0.0)
    assert again is not None
    assert again.until_s > decided.until_s + 5.0


def test_who_cannot_be_told_is_let_pass() -> None:
    asks = replace(MET["ada"], may_move=False, barred=False)
    decided = right_of_way().decide({"ada": asks, "bob": MET["bob"]}, 0.0)
    assert decided is not None
    assert decided.robot == "bob"


def test_who_rests_in_the_way_goes_and_nobody_makes_way_for_it() -> None:
    rests = Standing("F1", (5.4, 2.0), *BASE, may_move=True)
    decided = right_of_way().decide({"ada": MET["ada"], "bob": rests}, 0.0)
    assert decided is not None
    assert (decided.robot, decided.other) == ("bob", "ada")
    stays = replace(rests, may_move=False)
    assert right_of_way().decide({"ada": MET["ada"], "bob": stays}, 0.0) is None


def test_where_neither_can_nobody_does() -> None:
    pipe = two_rooms(
        (0, 1.5, 10, 1.5), (0, 2.5, 10, 2.5), (3.9, 1.5, 3.9, 2.5), (6.1, 1.5, 6.1, 2.5)
    )
    rights = right_of_way(pipe)
    assert rights.decide(MET, 0.0) is None
    assert rights.decide(MET, AGAIN_S + 0.1) is None


def test_what_does_not_help_time_and_again_is_left_to_people() -> None:
    rights, now_s = right_of_way(), 0.0
    for _ in range(MOST_TIMES):
        decided = rights.decide(MET, now_s)
        assert decided is not None
        now_s = decided.until_s + 1.0
    assert rights.decide(MET, now_s) is None
    assert rights.decide(MET, now_s + FORGET_S) is not None


@settings(max_examples=sample(13, 40))
@given(st.integers(0, 10_000), st.integers(4, 12), st.floats(0.6, 1.6), st.data())
def test_a_bay_is_clear_of_walls_and_of_the_way_that_is_made(
    seed: int, rooms: int, off_m: float, data: st.DataObject
) -> None:
    building = Building(random_building(seed, 1, rooms))
    floor = building.floors["F1"]
    name = data.draw(st.sampled_from(sorted(set(floor.doors) & set(floor.places))))
    lane = next(each for each in floor.lanes if name in each.between)
    room = floor.places[name]
    hall = floor.places[next(each for each in lane.between if each != name)]
    (ax, ay), (bx, by) = floor.doors[name].posts
    door = (ax + bx) / 2, (ay + by) / 2
    inside, outside = (_towards(door, (place.x, place.y), off_m / 2.0) for place in (room, hall))
    standings = {
        "ada": Standing("F1", inside, *BASE, [inside, door, (hall.x, hall.y)], True, True),
        "bob": Standing("F1", outside, *BASE, [outside, door, (room.x, room.y)], True, True),
    }
    decided = right_of_way(building).decide(standings, 0.0)
    assume(decided is not None)
    assert decided is not None
    bay, other = np.array([decided.way[-1]]), standings[decided.other]
    walls = floor.wall_segments
    assert distances_m(bay, walls)[0] >= RADIUS_M + WALL_M - 1.5 * CELL_M
    between_m = np.hypot(*(sampled(other.way) - bay[0]).T).min()
    assert between_m >= 2 * RADIUS_M + APART_M - 1.5 * CELL_M
    way = sampled([standings[decided.robot].at, *decided.way])
    assert distances_m(way, walls).min() >= RADIUS_M - 1.5 * CELL_M
    assert len(decided.way) < 200


def _towards(origin: Point, goal: Point, by_m: float) -> Point:
    share = by_m / math.dist(origin, goal)
    return origin[0] + share * (goal[0] - origin[0]), origin[1] + share * (goal[1] - origin[1])
