"""Legs in discrete events: where time goes, and what the same draws give."""

from random import Random

import pytest
from dispatch_office import asked, dispatcher_for, office, visit

from mend.fleet.dispatch.discrete_execution import DiscreteExecution, LegTimes
from mend.fleet.dispatch.leg import LegOutcome
from mend.fleet.dispatch.setting import Policy
from mend.fleet.dispatch.trip_times import LaneTrips
from mend.fleet.requests import RequestStatus

EXACT = LegTimes(
    start_share=0.0,
    elevator_mean_s=0.0,
    door_share=0.0,
    blocked_share=0.0,
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
