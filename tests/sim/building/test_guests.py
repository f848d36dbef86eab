"""People whom robots escort wait, follow, dawdle and ride along; nobody is touched."""

import json
import math
from itertools import pairwise, product

import pytest
from building_bench import BuildingBench, made_up
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.maps.building.building import Building, BuildingDocument, Caller
from mend.maps.building.cabin import CABIN_M
from mend.robots.base.companion import CAUGHT_UP_M, FALLS_BEHIND_M, GLIMPSE_S
from mend.robots.base.elevator_rides import ElevatorRides
from mend.robots.link.messages import Finished, Interrupt, IssueDetected, Look, Looked, Resume
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.cabin import CabinState
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.guest import Guest
from mend.sim.building.scene import scene_of
from mend.sim.building.way_on_foot import way_on_foot
from mend.tasks.intervention import Act, Intervention

ROBOT, LEE = "robot1", "Ms Lee"
SEND = Intervention(act=Act.SEND_PERSON)


def bench_of(seed: int = 4, floors: int = 1, **more: float) -> BuildingBench:
    document = made_up(floors, 6, 3).document.model_dump(mode="json")
    for each in document["elevators"].values():
        each["called_by"] = Caller.ROBOTS
    building = Building(BuildingDocument.model_validate_json(json.dumps(document)))
    return BuildingBench(scene_of(building, "office", 1), seed=seed, **more)  # type: ignore[arg-type]


def guest_of(bench: BuildingBench) -> Guest:
    return bench.world.guests.of_robots[0]


def away_m(bench: BuildingBench) -> float:
    """How far the guest is from the robot; inf on another floor."""
    robot, guest = bench.world.robots[0], guest_of(bench)
    if guest.where is None or guest.at.floor != robot.at.floor:
        return math.inf
    return math.hypot(guest.at.x - robot.at.x, guest.at.y - robot.at.y)


def meet(bench: BuildingBench, place: str = "F1-101") -> None:
    """Somebody is there, and is met; who is late is waited for, or sent."""
    bench.go(ROBOT, place, "meet_person", person=LEE)
    while not bench.of(Finished):
        bench.group.advance(0.25)
        if bench.of(IssueDetected) and not bench.of(Looked):
            bench.world.intervene(SEND)
            bench.send(ROBOT, Look(expect="accompanied", within_s=60.0))
            bench.run_until(Looked)
            bench.send(ROBOT, Resume(execution=bench.of(IssueDetected)[-1].execution))
        assert bench.group.time_s() < 200.0, "nobody is met"
    assert away_m(bench) <= CAUGHT_UP_M + 0.2


def lead(bench: BuildingBench, place: str) -> None:
    bench.go(ROBOT, place, "escort", person=LEE)


def is_at(bench: BuildingBench, place: str) -> bool:
    pose, at = bench.scene.places[place].pose, bench.world.robots[0].at
    floor = bench.world.building.floor_at(pose.z or 0.0)
    return floor == at.floor and math.hypot(pose.x - at.x, pose.y - at.y) < 0.1


def test_somebody_is_met_and_arrives_with_the_robot() -> None:
    bench = bench_of(dawdling=0.0)
    meet(bench)
    lead(bench, "F1-104")
    nearest_m = math.inf
    while bench.group.advance(0.05):
        nearest_m = min(nearest_m, away_m(bench))
        assert bench.world.robots[0].velocity().speed_m_s < 0.65, "a person follows"
    assert len(bench.of(Finished)) == 2
    assert is_at(bench, "F1-104")
    assert away_m(bench) <= CAUGHT_UP_M + 0.2
    assert nearest_m > bench.world.robots[0].radius_m + RADIUS_M
    assert bench.world.touches == 0
    assert not bench.of(IssueDetected)


@pytest.mark.slow
def test_robot_and_person_ride_together() -> None:
    bench = bench_of(floors=2, dawdling=0.0)
    meet(bench)
    lead(bench, "F2-201")
    rode = False
    while bench.group.advance(0.05):
        robot, guest = bench.world.robots[0], guest_of(bench)
        rode |= robot.at.floor == guest.at.floor == "/lift1"
        shut = bench.world.elevators.cabins["lift1"].state is not CabinState.OPEN
        assert shut <= (robot.at.floor.startswith("/") == guest.at.floor.startswith("/"))
    assert rode
    assert len(bench.of(Finished)) == 2
    assert is_at(bench, "F2-201")
    assert away_m(bench) <= CAUGHT_UP_M + 0.2
    assert bench.world.touches == 0


@pytest.mark.slow
def test_the_elevator_waits_for_who_is_still_outside_and_the_robot_asks_for_them() -> None:
    bench = bench_of(floors=2, dawdling=0.0)
    meet(bench)
    lead(bench, "F2-201")
    robot, cabin = bench.world.robots[0], bench.world.elevators.cabins["lift1"]
    while bench.world.elevators.stop_around(robot) is None:
        bench.group.advance(0.05)
        assert bench.group.time_s() < 200.0
    guest_of(bench).paused_until_s = math.inf
    guest_of(bench).led = False
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "fell_behind"
    assert cabin.is_open_at("F1")
    guest_of(bench).led = True
    assert bench.world.intervene(SEND) == ""
    bench.send(ROBOT, Look(expect="accompanied", within_s=60.0))
    assert bench.run_until(Looked).fulfilled
    bench.send(ROBOT, Resume(execution=issue.execution))
    bench.run()
    assert len(bench.of(Finished)) == 2
    assert is_at(bench, "F2-201")


@pytest.mark.slow
def test_who_is_left_on_another_floor_is_met_near_the_elevator_there() -> None:
    bench = bench_of(floors=2, dawdling=0.0)
    meet(bench)
    lead(bench, "F2-201")
    robot = bench.world.robots[0]
    while robot.at.floor != "F2":
        bench.group.advance(0.05)
        assert bench.group.time_s() < 200.0
    for _ in range(100):
        bench.group.advance(0.05)
    left = bench.scene.places["F1-102"].pose
    guest_of(bench).where = type(robot.at)("F1", left.x, left.y)
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "fell_behind"
    assert bench.world.intervene(SEND) == ""
    bench.send(ROBOT, Look(expect="accompanied", within_s=60.0))
    assert bench.run_until(Looked).fulfilled
    bench.send(ROBOT, Resume(execution=issue.execution))
    bench.run()
    assert len(bench.of(Finished)) == 2
    assert away_m(bench) <= CAUGHT_UP_M + 0.2


@pytest.mark.slow
def test_who_has_no_room_in_the_cabin_rides_alone_and_is_met_at_its_door(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(ElevatorRides, "_aside", lambda *_: None)
    bench = bench_of(floors=2, dawdling=0.0)
    meet(bench)
    lead(bench, "F2-201")
    issue = bench.run_until(IssueDetected)
    robot = bench.world.robots[0]
    assert (issue.issue, robot.at.floor, guest_of(bench).at.floor) == ("fell_behind", "F2", "F1")
    assert bench.world.intervene(SEND) == ""
    bench.send(ROBOT, Look(expect="accompanied", within_s=60.0))
    assert bench.run_until(Looked).fulfilled
    bench.send(ROBOT, Resume(execution=issue.execution))
    bench.run()
    assert len(bench.of(Finished)) == 2
    assert away_m(bench) <= CAUGHT_UP_M + 0.2
    assert bench.world.touches == 0


def test_who_dawdles_is_waited_for_and_asked_for() -> None:
    bench = bench_of(dawdling=0.0)
    meet(bench)
    lead(bench, "F1-104")
    while guest_of(bench).way_m(bench.world.robots[0].at) < 1.4:
        bench.group.advance(0.05)
    guest_of(bench).paused_until_s = guest_of(bench).thinks_s = math.inf
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "fell_behind"
    assert issue.detection is not None
    assert "saw who follows me last" in issue.detection.explanation
    bench.send(ROBOT, Look(expect="accompanied", within_s=0.0))
    assert not bench.run_until(Looked).fulfilled
    assert bench.world.intervene(SEND) == ""
    bench.send(ROBOT, Look(expect="accompanied", within_s=30.0))
    assert bench.run_until(Looked).fulfilled
    bench.send(ROBOT, Resume(execution=issue.execution))
    bench.run()
    assert len(bench.of(Finished)) == 2
    assert away_m(bench) <= CAUGHT_UP_M + 0.2


def out_of_sight(bench: BuildingBench, place: str) -> FloorPose:
    """Where somebody may stand who cannot be seen from a place, by the shortest way to it."""
    pose = bench.scene.places[place].pose
    middle, space = FloorPose("F1", pose.x, pose.y), bench.world._space
    ways: dict[float, FloorPose] = {}
    for away_m, angle in product((1.5, 2.0, 3.0, 4.0), range(0, 360, 15)):
        x = middle.x + away_m * math.cos(math.radians(angle))
        y = middle.y + away_m * math.sin(math.radians(angle))
        at = FloorPose("F1", x, y)
        if space.sees(middle, at) or space.touches(at, RADIUS_M + 0.1):
            continue
        way = way_on_foot((x, y), (middle.x, middle.y), space.segments("F1"))
        if way:
            ways[sum(math.dist(a, b) for a, b in pairwise([(x, y), *way]))] = at
    return ways[min(ways)]


def test_who_waits_out_of_sight_comes_to_the_robot() -> None:
    bench = bench_of(dawdling=0.0)
    bench.go(ROBOT, "F1-101", "meet_person", person=LEE)
    bench.group.advance(0.1)
    guest_of(bench).where = out_of_sight(bench, "F1-101")
    assert guest_of(bench).late_s == 0.0
    bench.run()
    assert bench.of(Finished)
    assert away_m(bench) <= CAUGHT_UP_M + 0.2
    assert not bench.of(IssueDetected)


def test_who_was_pushed_behind_a_wall_gets_round_it() -> None:
    bench = bench_of(dawdling=0.0)
    meet(bench)
    lead(bench, "F1-104")
    bench.group.advance(0.2)
    guest_of(bench).where = out_of_sight(bench, "F1-101")
    bench.run()
    assert len(bench.of(Finished)) == 2
    assert is_at(bench, "F1-104")
    assert away_m(bench) <= CAUGHT_UP_M + 0.2
    assert bench.world.touches == 0


def test_who_does_not_come_at_all_is_never_met() -> None:
    bench = bench_of(no_shows=1.0)
    bench.go(ROBOT, "F1-101", "meet_person", person=LEE)
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "person_not_there"
    assert bench.world.intervene(SEND) == "nobody here is called Ms Lee"
    bench.send(ROBOT, Look(expect="accompanied", within_s=60.0))
    assert not bench.run_until(Looked).fulfilled
    bench.send(ROBOT, Interrupt(retreat=True))
    bench.run()
    assert not bench.of(Finished)


def test_some_come_late_and_are_met_all_the_same() -> None:
    late = 0
    for seed in range(10):
        bench = bench_of(seed)
        bench.go(ROBOT, "F1-101", "meet_person", person=LEE)
        bench.group.advance(0.1)
        if guest_of(bench).late_s == 0.0:
            continue
        late += 1
        assert guest_of(bench).where is None
        if late == 1:
            meet(bench)
    assert late


@pytest.mark.slow
def test_who_was_led_away_is_met_where_they_are_asked_for_the_next_time() -> None:
    bench = bench_of(dawdling=0.0)
    for place in ("F1-104", "F1-103"):
        bench.reports.clear()
        meet(bench)
        lead(bench, place)
        bench.run()
        assert len(bench.of(Finished)) == 2
        assert is_at(bench, place)
        assert away_m(bench) <= CAUGHT_UP_M + 0.2


def test_nobody_is_told_to_come_where_no_robot_waits() -> None:
    assert bench_of().world.intervene(SEND) == "no robot that stands waits for anybody"


@pytest.mark.parametrize("cycles", [300, 800])
def test_they_go_on_from_a_snapshot_as_if_nothing_had_been(cycles: int) -> None:
    bench, other = bench_of(dawdling=1.0), bench_of(dawdling=1.0)
    meet(bench)
    lead(bench, "F1-104")
    for _ in range(cycles):
        bench.world.advance_cycle()
    bench.world.robots[0].stop()
    for _ in range(100):
        bench.world.advance_cycle()
    kept = json.loads(json.dumps(bench.world.snapshot(), allow_nan=False))
    other.world.restore(kept)
    for _ in range(400):
        bench.world.advance_cycle()
        other.world.advance_cycle()
    assert other.world.guests.snapshot() == bench.world.guests.snapshot()
    assert other.world.companions[0].sighting() == bench.world.companions[0].sighting()


def test_a_snapshot_from_before_anybody_was_escorted_is_still_read() -> None:
    bench = bench_of()
    kept = bench.world.snapshot()
    del kept["guests"], kept["guests_draws"], kept["companions"]
    bench.world.restore(kept)
    assert bench.world.guests.of_robots == {}


@pytest.mark.slow(3)
@settings(max_examples=sample(2, 12), deadline=None, suppress_health_check=list(HealthCheck))
@given(
    seed=st.integers(0, 20),
    stops=st.lists(st.tuples(st.floats(0.0, 20.0), st.floats(1.0, 18.0)), max_size=3),
)
def test_no_robot_drives_on_for_long_without_who_follows(
    seed: int, stops: list[tuple[float, float]]
) -> None:
    bench = bench_of(seed, dawdling=0.0)
    meet(bench)
    lead(bench, "F1-104")
    begin_s, left_s, brakes_s = bench.group.time_s(), 0.0, 1.0
    while bench.group.advance(0.05) and not bench.of(IssueDetected):
        now_s = bench.group.time_s() - begin_s
        for at_s, for_s in stops:
            if at_s <= now_s < at_s + 0.05:
                guest_of(bench).paused_until_s = begin_s + at_s + for_s
        seen = bench.world.companions[0].sighting()
        follows = seen is not None and seen.distance_m <= FALLS_BEHIND_M
        left_s = 0.0 if follows else left_s + 0.05
        if left_s > GLIMPSE_S + brakes_s:
            assert bench.world.robots[0].velocity().speed_m_s < 0.05
    assert bench.world.touches == 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample(range(1), range(2)))
def test_nobody_is_pushed_out_of_a_cabin_where_it_has_no_door(seed: int) -> None:
    bench = bench_of(seed, floors=2, dawdling=0.0)
    meet(bench)
    lead(bench, "F2-201")
    guest, robot = guest_of(bench), bench.world.robots[0]
    left = 0
    while bench.group.advance(0.05):
        stop = bench.world.elevators.stop_around(guest)
        if stop is None or robot.at.floor != "F2":
            continue
        off = guest.at.x - stop[0], guest.at.y - stop[1]
        towards = robot.at.x - stop[0], robot.at.y - stop[1]
        is_out = math.hypot(*towards) > CABIN_M + robot.radius_m
        left += is_out
        behind_m = -(off[0] * towards[0] + off[1] * towards[1]) / max(math.hypot(*towards), 1e-6)
        assert not is_out or behind_m < CABIN_M - RADIUS_M + 0.02
    assert left, "it has ridden along"
    assert len(bench.of(Finished)) == 2
