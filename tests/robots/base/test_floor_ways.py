"""Ways through a building lead along its lanes, not through its walls."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.maps.building.building import Building, BuildingDocument, Caller, FloorPlace, PlaceKind
from mend.maps.building.cabin import CABIN_M, cabin_walls, stop_of
from mend.maps.building.clearance import clearance_m, distances_m
from mend.maps.building.crossing import crossed_by
from mend.maps.building.random_building import random_building
from mend.robots.base.body import BasePose
from mend.robots.base.floor_ways import FloorWays
from mend.robots.execution.command_error import CommandError
from mend.tasks.frames import Frame


def document_of(name: str, floor: dict[str, object]) -> BuildingDocument:
    return BuildingDocument.model_validate_json(
        json.dumps({"building": name, "floors": {"F1": floor}})
    )


@pytest.mark.parametrize("seed", range(6))
def test_no_way_leads_through_a_wall_and_each_ends_at_its_goal(seed: int) -> None:
    building = Building(random_building(seed, 2, 12))
    frame = Frame(3.0, -1.0, quarters=seed % 4)
    ways = FloorWays(building, frame, 1.0, 0.3)
    for name, floor in building.floors.items():
        walls = np.array(floor.walls)
        poses = [
            BasePose(*frame.to_robot(each.x, each.y), 0.0, floor.height)
            for each in floor.places.values()
        ]
        for here, to in zip(poses, reversed(poses), strict=True):
            way = [(here.x, here.y), *ways.path(here, to)]
            assert math.dist(way[-1], (to.x, to.y)) < 1e-9
            for a, b in pairwise(way):
                leg = np.array([*frame.to_scene(*a), *frame.to_scene(*b)])
                assert not len(crossed_by(leg, walls)), f"{name}: {a} to {b}"


def test_a_door_on_the_way_has_its_name() -> None:
    building = Building(random_building(3, 1, 4))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    floor = building.floors["F1"]
    for name, door in floor.doors.items():
        (x0, y0), (x1, y1) = door.posts
        x, y = (x0 + x1) / 2, (y0 + y1) / 2
        assert ways.door_at(BasePose(x, y - 0.5, 0.0), (x, y + 0.5)) == name
        assert ways.door_at(BasePose(x, y - 0.5, 0.0), (x, y - 0.1)) is None


@pytest.mark.parametrize("seed", range(4))
def test_who_is_on_a_lane_knows_its_ends_the_one_behind_first(seed: int) -> None:
    building = Building(random_building(seed, 2, 8))
    frame = Frame(3.0, -1.0, quarters=seed)
    ways = FloorWays(building, frame, 1.0, 0.3)
    for name, floor in building.floors.items():
        for lane in floor.lanes:
            a, b = (floor.places[each] for each in lane.between)
            near, far = (
                frame.to_robot(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y))
                for share in (0.45, 0.55)
            )
            ends = tuple(f"{name}/{each}" for each in lane.between)
            assert ways.lane_at(BasePose(*near, 0.0, floor.height), far) == ends
            assert ways.lane_at(BasePose(*far, 0.0, floor.height), near) == ends[::-1]
        off = BasePose(*frame.to_robot(-500.0, 0.0), 0.0, floor.height)
        assert ways.lane_at(off, (off.x + 0.5, off.y)) is None


def test_what_is_on_no_floor_is_said() -> None:
    building = Building(random_building(3, 2, 4))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    here = BasePose(1.3, 0.0, 0.0)
    with pytest.raises(CommandError, match="no floor is 9 m high"):
        ways.path(here, BasePose(1.3, 0.0, 0.0, 9.0))
    with pytest.raises(CommandError, match="the way from F1 to F2 needs an elevator"):
        ways.path(here, BasePose(1.3, 0.0, 0.0, building.floors["F2"].height))


def test_lanes_are_kept_to_where_no_wall_is_and_doors_with_hours_are_gone_to() -> None:
    """Open ground is no way: the lanes lead round what the map does not have."""
    places: dict[str, object] = {"a": {"x": 0.0, "y": 0.0}, "b": {"x": 20.0, "y": 0.0}}
    places |= {"corner": {"x": 0.0, "y": 10.0}, "other": {"x": 20.0, "y": 10.0}}
    lanes = [("a", "corner"), ("corner", "other"), ("other", "b")]
    floor = {
        "places": places,
        "lanes": [{"between": each} for each in lanes],
        "doors": {"shop": {"posts": ((19.0, 5.0), (21.0, 5.0)), "open_s": ((10.0, 20.0),)}},
    }
    document = document_of("yard", floor)
    ways = FloorWays(Building(document), Frame(), 1.0, 0.3)
    path = ways.path(BasePose(0.0, 0.0, 0.0), BasePose(20.0, 0.0, 0.0))
    assert list(path) == [(0.0, 10.0), (20.0, 10.0), (20.0, 0.0)]


def test_nobody_leaves_the_lanes_through_a_gap_that_is_too_narrow() -> None:
    floor = {
        "places": {
            "a": {"x": 0.0, "y": 0.0},
            "b": {"x": 3.0, "y": 3.0},
            "by": {"x": 4.0, "y": 0.0},
        },
        "lanes": [{"between": ("a", "by")}, {"between": ("by", "b")}],
        "walls": ((0.0, 2.0, 1.8, 2.0), (2.2, 2.0, 3.2, 2.0)),
    }
    document = document_of("gap", floor)
    here, to = BasePose(1.0, 0.0, 0.0), BasePose(3.0, 3.0, 0.0)
    assert (4.0, 0.0) in FloorWays(Building(document), Frame(), 1.0, 0.3).path(here, to)


def test_who_comes_out_onto_a_lane_does_not_go_back_to_where_it_begins() -> None:
    floor = {
        "places": {
            "behind": {"x": -1.8, "y": -0.5},
            "ahead": {"x": 3.0, "y": -0.5},
            "goal": {"x": 9.0, "y": -0.5},
        },
        "lanes": [{"between": ("behind", "ahead")}, {"between": ("ahead", "goal")}],
        "walls": ((-5.0, 0.5, -0.6, 0.5), (0.6, 0.5, 9.0, 0.5)),
    }
    ways = FloorWays(Building(document_of("pocket", floor)), Frame(), 1.0, 0.3)
    path = ways.path(BasePose(0.0, 1.5, 0.0), BasePose(9.0, -0.5, 0.0))
    assert [y for _, y in path] == [-0.5] * len(path)
    along = [x for x, _ in path]
    assert along == sorted(along)
    assert along[0] > -0.6


@pytest.mark.parametrize("quarters", range(4))
def test_walls_around_a_pose_are_known_also_where_nothing_is_seen(quarters: int) -> None:
    floor = {"walls": [[0.0, 1.0, 3.0, 1.0], [20.0, 0.0, 20.0, 9.0]]}
    frame = Frame(2.0, -1.0, quarters=quarters)
    ways = FloorWays(Building(document_of("hut", floor)), frame, 1.0, 0.3)
    here = BasePose(*frame.to_robot(1.0, 0.0), 0.4)
    walls = np.array([frame.to_scene(x, y) for x, y in ways.walls(here).tolist()])
    assert np.allclose(walls[:, 1], 1.0)
    assert np.all(np.diff(np.sort(walls[:, 0])) <= 0.15 + 1e-9)
    assert walls[:, 0].min() == pytest.approx(0.0)
    assert walls[:, 0].max() == pytest.approx(3.0)


@pytest.mark.parametrize("seed", range(6))
def test_rides_lead_from_floor_to_floor_and_end_where_the_place_is(seed: int) -> None:
    building = Building(random_building(seed, 4, 10))
    frame = Frame(3.0, -1.0, quarters=seed % 4)
    ways = FloorWays(building, frame, 1.0, 0.3, turn=seed)
    low, high = building.floors["F1"], building.floors["F4"]
    here = pose_of(frame, low.places["101"], low.height)
    to = pose_of(frame, high.places["402"], high.height)
    rides = ways.rides(here, to)
    assert [(each.from_floor, each.to_floor) for each in rides] == [("F1", "F4")]
    (ride,) = rides
    assert ride.wait_at is not None
    assert ways.path(here, ride.wait_at)
    assert ways.path(ride.there, to)
    assert ways.floor(ride.there) == "F4"
    assert ride.wait_at.distance_m(ride.inside) > 0.9
    assert not ways.rides(here, pose_of(frame, low.places["102"], low.height))


@pytest.mark.parametrize("seed", range(6))
def test_the_way_to_where_one_waits_and_from_there_leads_round_the_cabin(seed: int) -> None:
    building = Building(random_building(seed, 2, 12))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    floors = building.floors
    stop = floors["F1"].places["lift1"]
    here = pose_of(Frame(), floors["F1"].places["101"], floors["F1"].height)
    (ride,) = ways.rides(here, pose_of(Frame(), floors["F2"].places["202"], floors["F2"].height))
    assert ride.wait_at is not None
    for begin, end in ((here, ride.wait_at), (ride.wait_at, here)):
        way = [(begin.x, begin.y), *ways.path(begin, end)]
        for a, b in pairwise(way):
            points = np.linspace(a, b, 50)
            assert np.hypot(points[:, 0] - stop.x, points[:, 1] - stop.y).min() > 0.9 - 1e-6
            leg = np.array([*a, *b])
            assert not len(crossed_by(leg, floors["F1"].wall_segments))


def test_who_is_in_a_cabin_does_not_wait_for_it() -> None:
    building = Building(random_building(2, 3, 6))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    floors = building.floors
    inside = pose_of(Frame(), floors["F2"].places["lift1"], floors["F2"].height)
    (ride,) = ways.rides(inside, pose_of(Frame(), floors["F1"].places["101"], 0.0))
    assert ride.wait_at is None


def test_a_cabin_has_room_for_two_beside_its_middle_unless_walls_are_too_near() -> None:
    document = random_building(2, 3, 6)
    floor = document.floors["F2"]
    to = pose_of(Frame(), document.floors["F1"].places["101"], 0.0)
    here = pose_of(Frame(), floor.places["201"], floor.height)
    (ride,) = FloorWays(Building(document), Frame(), 1.0, 0.3).rides(here, to)
    assert ride.aside is not None
    assert ride.aside.distance_m(ride.inside) == pytest.approx(0.25)
    off_x, off_y = ride.aside.x - ride.inside.x, ride.aside.y - ride.inside.y
    ends = [(ride.inside.x + n * off_x, ride.inside.y + n * off_y) for n in (2.1, 2.4)]
    walls = [*floor.walls, (*ends[0], *ends[1])]
    told = document.model_dump(mode="json")
    told["floors"]["F2"]["walls"] = walls
    narrow = Building(BuildingDocument.model_validate_json(json.dumps(told)))
    (ride,) = FloorWays(narrow, Frame(), 1.0, 0.3).rides(here, to)
    assert ride.aside is None


def test_the_walls_around_a_pose_are_known_and_a_cabin_has_a_name() -> None:
    building = Building(random_building(2, 2, 6))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    stop = building.floors["F1"].places["lift1"]
    near = ways.walls(BasePose(stop.x, stop.y, 0.0))
    walls = building.floors["F1"].wall_segments
    assert len(near)
    assert distances_m(near, walls).max() < 1e-9
    assert np.abs(near - (stop.x, stop.y)).max() < 6.0
    inside, beside = BasePose(stop.x, stop.y, 0.0), BasePose(stop.x + 0.9, stop.y, 0.0)
    assert ways.door_at(inside, (stop.x + 0.9, stop.y)) == "lift1"
    assert (ways.elevator_at(inside), ways.elevator_at(beside)) == ("lift1", None)


def test_an_elevator_is_seen_right_across_its_cabin_by_who_is_outside_of_it() -> None:
    told = random_building(2, 2, 6).model_dump(mode="json")
    for floor in told["floors"].values():
        floor["doors"] = {}
    building = Building(BuildingDocument.model_validate_json(json.dumps(told)))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    x, y = stop_of(building, "lift1", "F1")
    assert ways.posts("lift1", BasePose(x, y, 0.0)) is None
    across = ways.posts("lift1", BasePose(x + 0.9, y, 0.0))
    assert across is not None
    assert np.allclose(sorted(across), [(x, y - CABIN_M), (x, y + CABIN_M)])


@pytest.mark.parametrize("seed", range(4))
def test_no_way_to_where_a_robot_waits_leads_through_the_cabin(seed: int) -> None:
    building = Building(random_building(seed, 2, 6 + 5 * seed))
    room = next(e for e in building.of_kind(PlaceKind.ROOM) if e.startswith("F1/"))
    away = next(e for e in building.of_kind(PlaceKind.ROOM) if e.startswith("F2/"))
    here, to = (_pose_at(building, each) for each in (room, away))
    for turn in range(12):
        ways = FloorWays(building, Frame(), 1.0, 0.3, turn)
        (ride,) = ways.rides(here, to)
        assert ride.wait_at is not None
        walls = cabin_walls(stop_of(building, ride.elevator, "F1"))
        way = [(here.x, here.y), *ways.path(here, ride.wait_at)]
        assert not any(len(crossed_by(np.array([*a, *b]), walls)) for a, b in pairwise(way))


def _pose_at(building: Building, place: str) -> BasePose:
    floor, name = place.split("/")
    on = building.floors[floor]
    return BasePose(on.places[name].x, on.places[name].y, 0.0, on.height)


def pose_of(frame: Frame, place: FloorPlace, height_m: float) -> BasePose:
    return BasePose(*frame.to_robot(place.x, place.y), 0.0, height_m)


def rings(seed: int) -> tuple[Building, FloorWays]:
    building = Building(random_building(seed % 7, 1 + seed % 3, 20 + 10 * (seed % 2)))
    return building, FloorWays(building, Frame(), 1.0, 0.3)


@settings(max_examples=sample(8, 25), deadline=None)
@given(seed=st.integers(0, 6), data=st.data())
def test_what_is_closed_is_gone_by_only_where_no_other_way_leads(
    seed: int, data: st.DataObject
) -> None:
    """Against a search of its own: whether a way is left once what is closed is taken out."""
    building, ways = rings(seed)
    floor = building.floors["F1"]
    lanes = [frozenset(f"F1/{each}" for each in lane.between) for lane in floor.lanes]
    shut = data.draw(st.sets(st.sampled_from(lanes), max_size=8))
    names = [n for n, each in floor.places.items() if each.kind is not PlaceKind.ELEVATOR]
    start, goal = (data.draw(st.sampled_from(names)) for _ in range(2))
    here, to = (pose_of(Frame(), floor.places[each], floor.height) for each in (start, goal))
    closed = dict.fromkeys(shut)
    path = ways.path(here, to, closed)
    assert math.dist(path[-1], (to.x, to.y)) < 1e-9
    stops = {f"F1/{n}" for n, each in floor.places.items() if each.kind is PlaceKind.ELEVATOR}
    open_ = [each for each in lanes if each not in shut and not each & stops]
    left = reached_from(f"F1/{start}", open_)
    assert ways.leads_round(here, to, closed) is (f"F1/{goal}" in left)
    if f"F1/{goal}" in left:
        way = [(here.x, here.y), *path]
        for lane in shut:
            a, b = (floor.places[each.removeprefix("F1/")] for each in sorted(lane))
            middle = ((a.x + b.x) / 2, (a.y + b.y) / 2)
            assert all(off_m(middle, *leg) > 1e-6 for leg in pairwise(way))


def reached_from(start: str, lanes: list[frozenset[str]]) -> set[str]:
    reached, new = set[str](), {start}
    while new:
        reached |= new
        new = {end for lane in lanes if lane & new for end in lane} - reached
    return reached


def off_m(point: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    return float(distances_m(np.array([point]), np.array([[*a, *b]]))[0])


def test_a_closed_elevator_is_left_where_another_one_rides_there() -> None:
    building = Building(random_building(1, 3, 60))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    floors = building.floors
    here = pose_of(Frame(), floors["F1"].places["101"], floors["F1"].height)
    to = pose_of(Frame(), floors["F3"].places["301"], floors["F3"].height)
    (ride,) = ways.rides(here, to)
    stops = [f"{f}/{at}" for f, at in building.document.elevators[ride.elevator].stops.items()]
    closed = {frozenset((a, b)): None for a in stops for b in stops if a != b}
    (instead,) = ways.rides(here, to, closed)
    assert instead.elevator != ride.elevator
    everything = {
        frozenset((way.a, way.b)): None for way in building.graph.ways if way.kind == "elevator"
    }
    assert ways.rides(here, to, everything) == [ride]


def test_who_stands_before_what_is_barred_goes_back_from_there() -> None:
    places: dict[str, object] = {"a": {"x": 0.0, "y": 0.0}, "b": {"x": 10.0, "y": 0.0}}
    places |= {"c": {"x": 0.0, "y": 9.0}, "d": {"x": 10.0, "y": 9.0}}
    lanes = [("a", "b"), ("a", "c"), ("c", "d"), ("d", "b")]
    walls = ((1.0, 1.0, 9.0, 1.0), (-1.0, -1.0, 11.0, -1.0))
    floor = {"places": places, "lanes": [{"between": each} for each in lanes], "walls": walls}
    ways = FloorWays(Building(document_of("ring", floor)), Frame(), 1.0, 0.3)
    here, to = BasePose(7.0, 0.0, 0.0), BasePose(10.0, 0.0, 0.0)
    lane = frozenset(("F1/a", "F1/b"))
    assert list(ways.path(here, to)) == [(10.0, 0.0)]
    round_ = [(0.0, 0.0), (0.0, 9.0), (10.0, 9.0), (10.0, 0.0)]
    assert list(ways.path(here, to, {lane: "F1/a"})) == round_
    assert list(ways.path(here, to, {lane: "F1/b"})) == [(10.0, 0.0)]
    there = BasePose(9.8, 0.0, 0.0)
    assert list(ways.path(there, to, {lane: "F1/a"})) == [(10.0, 0.0)]


def test_an_elevator_that_others_wait_for_is_left_where_another_one_is_quicker() -> None:
    document = random_building(1, 3, 60)
    lifts = {
        name: each.model_copy(update={"called_by": Caller.ROBOTS})
        for name, each in document.elevators.items()
    }
    building = Building(document.model_copy(update={"elevators": lifts}))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    floors = building.floors
    here = pose_of(Frame(), floors["F1"].places["101"], floors["F1"].height)
    to = pose_of(Frame(), floors["F3"].places["301"], floors["F3"].height)
    (ride,) = ways.rides(here, to)
    assert ways.rides(here, to, waits_s={ride.elevator: 0.5}) == [ride]
    (instead,) = ways.rides(here, to, waits_s={ride.elevator: 1000.0})
    assert instead.elevator != ride.elevator
    everywhere = dict.fromkeys(lifts, 1000.0)
    assert ways.rides(here, to, waits_s=everywhere) == [ride]


@pytest.mark.parametrize("seed", range(6))
def test_whoever_was_pushed_out_of_sight_of_the_lanes_still_gets_to_an_elevator(seed: int) -> None:
    """Round the corner of a lobby no place but the elevator's stop may be in straight sight."""
    building = Building(random_building(seed, 2, 12))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    floor, above = building.floors["F1"], building.floors["F2"]
    goal = next(iter(above.places.values()))
    to = BasePose(goal.x, goal.y, 0.0, above.height)
    walls, generator = floor.wall_segments, np.random.default_rng(seed)
    for elevator in building.document.elevators:
        stop = stop_of(building, elevator, "F1")
        for off in generator.uniform(-3.0, 3.0, (40, 2)):
            at = np.array(stop) + off
            sees_cabin = not len(crossed_by(np.array([*stop, *at]), walls))
            if sees_cabin and distances_m(at[None], walls)[0] >= 0.3 and math.hypot(*off) > CABIN_M:
                here = BasePose(*at.tolist(), 0.0, floor.height)
                assert [each.to_floor for each in ways.rides(here, to)] == ["F2"]


@pytest.mark.parametrize("seed", range(6))
def test_no_way_between_places_outside_of_all_cabins_leads_through_one(seed: int) -> None:
    building = Building(random_building(seed, 2, 8))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    generator = np.random.default_rng(seed)
    for name, floor in building.floors.items():
        stops = [
            stop_of(building, elevator, name)
            for elevator, each in building.document.elevators.items()
            if name in each.stops
        ]
        around = generator.uniform(-4.0, 4.0, (30, 2)) + np.repeat(stops, 30 // len(stops), axis=0)
        goals = [each for each in floor.places.values() if each.kind is not PlaceKind.ELEVATOR]
        for at in around:
            if distances_m(at[None], floor.wall_segments)[0] < 0.3:
                continue
            if min(math.dist(at, stop) for stop in stops) < CABIN_M + 0.3:
                continue
            to = goals[generator.integers(len(goals))]
            here = BasePose(*at.tolist(), 0.0, floor.height)
            try:
                way = ways.path(here, BasePose(to.x, to.y, 0.0, floor.height))
            except CommandError:
                continue  # It stands in a room without a door.
            for a, b in pairwise([tuple(at.tolist()), *way]):
                for stop in stops:
                    assert clearance_m(a, b, np.array([[*stop, *stop]])) >= CABIN_M, f"{name}: {at}"
