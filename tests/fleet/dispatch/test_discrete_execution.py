"""Legs in discrete events: where time goes, and what the same draws give."""

from random import Random

import pytest
from dispatch_office import asked, dispatcher_for, office, visit

from mend.fleet.dispatch.discrete_execution import DiscreteExecution, LegRecord, LegTimes
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import LegOutcome
from mend.fleet.dispatch.setting import FleetSetting, Policy, ServiceRobot
from mend.fleet.dispatch.trip_times import LaneTrips
from mend.fleet.requests import RequestStatus
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.maps.building.trip import Trip, TripRide, TripStage

EXACT = LegTimes(
    start_share=0.0,
    elevator_mean_s=0.0,
    door_share=0.0,
    blocked_share=0.0,
    detour_mean_s=0.0,
    end_mean_s=0.0,
    fails=0.0,
    loses=0.0,
)

TRIPS = LaneTrips(office().graph, 1.0)


def test_without_chance_everything_is_done_as_planned() -> None:
    dispatcher = dispatcher_for("a")
    answer = dispatcher.submit(asked(), 0.0)
    execution = DiscreteExecution(dispatcher, TRIPS, EXACT, Random(1))
    execution.run_until(39.0)
    assert dispatcher.view("tea").status is RequestStatus.UNDER_WAY
    execution.run_until(41.0)
    assert dispatcher.view("tea").status is RequestStatus.DONE
    assert answer.expected is not None
    assert answer.expected.done_s == pytest.approx(40.0)
    assert [record.driving_s for record in execution.records] == pytest.approx([10.0, 20.0])


def test_robot_that_is_there_too_soon_waits_for_the_window() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(visit(earliest_s=500.0), 0.0)
    execution = DiscreteExecution(dispatcher, TRIPS, EXACT, Random(1))
    execution.run_until(1000.0)
    (record,) = execution.records
    assert record.begun_s == pytest.approx(450.0)
    assert record.waiting_s == pytest.approx(30.0)


def test_leg_that_always_fails_ends_with_its_request() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(max_attempts=2, retry_after_s=100.0))
    dispatcher.submit(asked(), 0.0)
    fails = EXACT.model_copy(update={"fails": 1.0})
    execution = DiscreteExecution(dispatcher, TRIPS, fails, Random(1))
    execution.run_until(1000.0)
    assert [record.outcome for record in execution.records] == [LegOutcome.FAILED] * 2
    assert dispatcher.view("tea").status is RequestStatus.FAILED


def test_leg_of_a_robot_that_failed_meanwhile_is_over() -> None:
    dispatcher = dispatcher_for("a", "e")
    dispatcher.submit(asked(), 0.0)
    execution = DiscreteExecution(dispatcher, TRIPS, EXACT, Random(1))

    def fail() -> str:
        dispatcher.robot_failed("r0", None, "it fell", execution.now_s)
        return "r0 fell"

    execution.call_at(20.0, fail)
    execution.run_until(500.0)
    assert dispatcher.view("tea").status is RequestStatus.DONE
    assert {record.leg.robot for record in execution.records[1:]} == {"r1"}


def test_leg_that_is_not_wanted_any_more_is_broken_off() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    execution = DiscreteExecution(dispatcher, TRIPS, EXACT, Random(1))

    def cancel() -> str:
        dispatcher.cancel("tea", execution.now_s)
        return "cancelled"

    execution.call_at(5.0, cancel)
    execution.run_until(500.0)
    assert [record.outcome for record in execution.records] == [LegOutcome.WITHDRAWN]
    assert dispatcher.view("tea").status is RequestStatus.CANCELLED


@pytest.mark.parametrize(("cancelled_s", "place"), [(5.0, "a"), (12.0, "b"), (25.0, "c")])
def test_who_breaks_off_a_leg_is_where_it_has_come_to(cancelled_s: float, place: str) -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(visit(place="e"), 0.0)
    execution = DiscreteExecution(dispatcher, TRIPS, EXACT, Random(1))

    def cancel() -> str:
        dispatcher.cancel("visit", execution.now_s)
        return "cancelled"

    execution.call_at(cancelled_s, cancel)
    execution.run_until(cancelled_s + 0.5)
    robot = dispatcher.fleet.robots["r0"]
    assert dispatcher.building.graph.places[robot.place].name == f"f/{place}"


class RidingTrips:
    """Every trip to the other floor passes a door and rides, ten seconds before and after."""

    def trip(self, origin: str, destination: str) -> Trip:
        begin, end = origin.split("/")[0], destination.split("/")[0]
        if begin == end:
            return [TripStage(10.0, 8.0)]
        ride = TripRide("lift1", begin, end, gets_in_s=4.0, gets_out_s=1.0)
        return [TripStage(10.0, 8.0, doors=1, ride=ride), TripStage(10.0, 8.0)]


def upstairs(times: LegTimes, seed: int) -> list[LegRecord]:
    """Two robots that set out at once, each to another room of the floor above."""
    building = Building(random_building(1, 2, 6))
    robots = tuple(ServiceRobot(name=f"r{n}", start=f"F1/10{n}") for n in (1, 2))
    dispatcher = Dispatcher(building, FleetSetting(robots=robots))
    for number in (1, 2):
        wanted = visit(f"v{number}", f"F2/20{number}", latest_s=200.0, stay_s=300.0)
        dispatcher.submit(wanted, 0.0)
    execution = DiscreteExecution(dispatcher, RidingTrips(), times, Random(seed))
    execution.run_until(1000.0)
    return execution.records


def test_an_elevator_takes_one_robot_at_a_time() -> None:
    first, second = sorted(upstairs(EXACT, 1), key=lambda each: each.elevator_s)
    # In, the door, a floor; then the door opens, shuts, and the cabin comes back.
    assert first.elevator_s == pytest.approx(4.0 + 2.0 + 5.0)
    assert second.elevator_s == pytest.approx(2.0 * first.elevator_s + 2.0 + 2.0 + 5.0)
    assert [each.driving_s for each in (first, second)] == [20.0, 20.0]
    assert [each.driven_m for each in (first, second)] == [16.0, 16.0]


def test_a_door_that_is_shut_is_waited_for() -> None:
    shut = EXACT.model_copy(update={"door_share": 1.0, "door_mean_s": 30.0})
    assert all(each.blocked_s > 0.0 for each in upstairs(shut, 1))
    assert all(each.blocked_s == 0.0 for each in upstairs(EXACT, 1))


def test_the_same_seed_gives_the_same_events() -> None:
    assert upstairs(LegTimes(), 5) == upstairs(LegTimes(), 5)
    assert upstairs(LegTimes(), 5) != upstairs(LegTimes(), 6)
