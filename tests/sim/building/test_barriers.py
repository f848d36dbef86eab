"""Ways that somebody bars: locked doors, and things right across corridors."""

import numpy as np
import pytest
from building_bench import BuildingBench

from mend.maps.building.building import Building, BuildingDocument, DoorOpening
from mend.maps.building.clearance import apart_m
from mend.maps.building.random_building import random_building
from mend.robots.link.messages import Intervened
from mend.sim.building.barriers import Barriers
from mend.sim.building.doors import WorldDoors
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Base

OFFICE = Building(random_building(11, 2, 30))
LANES = [
    (f"{each.floor}/{each.lane.between[0]}", f"{each.floor}/{each.lane.between[1]}")
    for each in OFFICE.crossings
]
WITH_DOOR = {lane: each.doors for lane, each in zip(LANES, OFFICE.crossings, strict=True)}


def barriers() -> tuple[Barriers, WorldDoors]:
    doors = WorldDoors(OFFICE, lambda _: False)
    return Barriers(OFFICE, doors), doors


def crosses(lane: tuple[str, str], segments: np.ndarray) -> bool:
    floor, _ = lane[0].split("/")
    ends = [OFFICE.floors[floor].places[each.split("/")[1]] for each in lane]
    along = np.linspace((ends[0].x, ends[0].y), (ends[1].x, ends[1].y), 200)
    return bool(apart_m(along, segments).min() < 0.1)


@pytest.mark.parametrize("lane", LANES[::9])
def test_what_bars_a_lane_is_right_across_it_until_it_is_cleared(lane: tuple[str, str]) -> None:
    made, doors = barriers()
    floor = lane[0].split("/")[0]
    put = made.bar(lane)
    if WITH_DOOR[lane]:
        assert put is None
        names = [f"{floor}/{each}" for each in WITH_DOOR[lane]]
        doors.let_pass(1.0, lambda _: [])
        assert all(doors[name].is_shut and not doors[name].may_be_passed(1.0) for name in names)
    else:
        assert put is not None
        assert crosses(lane, made.segments(floor))
    assert made.snapshot() == [(min(lane), max(lane))]
    made.clear((lane[1], lane[0]))
    assert not len(made.segments(floor))
    assert not any(each.is_locked for each in doors.values())


def test_a_door_is_not_locked_on_who_stands_in_it() -> None:
    made, doors = barriers()
    lane = next(each for each, through in WITH_DOOR.items() if through)
    floor = lane[0].split("/")[0]
    door = doors[f"{floor}/{WITH_DOOR[lane][0]}"]
    made.bar(lane)
    (x0, y0), (x1, y1) = door.plan.posts
    middle = ((x0 + x1) / 2, (y0 + y1) / 2, 0.2)
    doors.let_pass(1.0, lambda on: [middle] if on == floor else [])
    assert not door.is_shut
    doors.let_pass(2.0, lambda _: [])
    assert door.is_shut


def test_a_rebuilt_one_bars_the_same_and_nothing_else() -> None:
    made, _ = barriers()
    for lane in LANES[::7]:
        made.bar(lane)
    again, doors = barriers()
    again.bar(LANES[1])
    again.restore(made.snapshot())
    assert sorted(again.snapshot()) == sorted(made.snapshot())
    for floor in OFFICE.floors:
        assert np.array_equal(again.segments(floor), made.segments(floor))
    for lane in made.snapshot():
        again.clear(lane)
    assert not any(each.is_locked for each in doors.values())


def test_what_is_no_lane_or_barred_already_or_free_is_refused() -> None:
    made, _ = barriers()
    with pytest.raises(ValueError, match="no lane leads between F1/nowhere and F1/hall"):
        made.bar(("F1/nowhere", "F1/hall"))
    with pytest.raises(ValueError, match="nothing bars the way"):
        made.clear(LANES[0])
    made.bar(LANES[0])
    with pytest.raises(ValueError, match="is barred already"):
        made.bar((LANES[0][1], LANES[0][0]))


def hall(at_x: float, **more: object) -> BuildingBench:
    """A robot in a corridor between two places."""
    floor = {
        "places": {"a": {"x": 1.0, "y": 1.0}, "b": {"x": 5.0, "y": 1.0}},
        "lanes": ({"between": ("a", "b")},),
        "walls": ((0, 0, 6, 0), (6, 0, 6, 2), (6, 2, 0, 2), (0, 2, 0, 0)),
        **more,
    }
    document = BuildingDocument.model_validate({"building": "hall", "floors": {"F1": floor}})
    scene = scene_of(Building(document), "hall", 1)
    standing = scene.model_copy(update={"robots": {"robot": Base(x=at_x, y=1.0)}})
    return BuildingBench(standing, shut_doors=1.0)


BAR = Intervention(act=Act.BAR, between=("F1/a", "F1/b"))
CLEAR = Intervention(act=Act.CLEAR, between=("F1/a", "F1/b"))
HELP = Intervention(act=Act.RELEASE)


def test_nothing_is_put_where_a_robot_stands() -> None:
    bench = hall(3.0)
    assert bench.world.intervene(BAR) == "somebody is in the way between F1/a and F1/b"
    assert bench.world.intervene(CLEAR) == "nothing bars the way between F1/a and F1/b"


def test_who_helps_is_told_that_what_is_right_across_stays_there_and_not_that_nothing_is() -> None:
    bench = hall(2.0)
    assert bench.world.intervene(HELP) == "nothing is in the way of any robot"
    assert not bench.world.intervene(BAR)
    told = "what is right across a robot's way is not to be taken away yet"
    assert bench.world.intervene(HELP) == told


@pytest.mark.parametrize(
    "hours",
    [
        pytest.param((), id="somebody has locked it"),
        pytest.param(((100.0, 200.0),), id="it is none of its hours"),
    ],
)
def test_who_helps_is_told_that_a_door_stays_shut(hours: tuple[tuple[float, float], ...]) -> None:
    walls = ((0, 0, 6, 0), (6, 0, 6, 2), (6, 2, 0, 2), (0, 2, 0, 0), (3, 0, 3, 0.4), (3, 1.6, 3, 2))
    door = {"posts": ((3.0, 0.4), (3.0, 1.6)), "opens": DoorOpening.PEOPLE, "open_s": hours}
    bench = hall(2.3, walls=walls, doors={"d": door})
    if not hours:
        assert not bench.world.intervene(BAR)
    told = "the door that a robot stands before is locked, or not to be opened by now"
    assert bench.world.intervene(HELP) == told


def test_what_a_script_does_is_told_by_a_robot_that_has_a_task() -> None:
    lane = ("F1/101", "F1/102")
    script = ScriptedIntervention(at_s=0.5, do=Intervention(act=Act.BAR, between=lane))
    bench = BuildingBench(robots=2, interventions=[script])
    bench.go("robot2", "F1-103")
    bench.run_until(Intervened)
    assert [name for name, body in bench.reports if isinstance(body, Intervened)] == ["robot2"]
