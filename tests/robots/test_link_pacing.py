import random

from hypothesis import given, settings
from hypothesis import strategies as st

from mend.robots.link.backoff import Backoff
from mend.robots.link.command_memory import CommandMemory
from mend.robots.link.pacing import HORIZON_S, LONGEST_S, SHORTEST_S, WALL_BUDGET_S, Pacer


def drive(pacer: Pacer, pace: float | None, cost: float, wall_s: float) -> tuple[float, float]:
    """Advance a robot whose seconds cost `cost` wall seconds; returns (wall, robot) time."""
    now = robot = 0.0
    while now < wall_s:
        delay_s = pacer.delay_s(pace, now, robot)
        if delay_s > 0.0:
            now += delay_s
            continue
        slice_s = pacer.slice_s(pace)
        pacer.took(slice_s * cost, slice_s)
        now += slice_s * cost
        robot += slice_s
    return now, robot


@settings(deadline=None, max_examples=50)
@given(st.floats(0.1, 20.0), st.floats(0.0001, 0.04))
def test_a_robot_that_can_keeps_its_pace(pace: float, cost: float) -> None:
    now, robot = drive(Pacer(), pace, cost, wall_s=5.0)
    assert abs(robot / now - pace) <= 0.02 * pace


def test_without_a_pace_nothing_is_waited_for() -> None:
    pacer = Pacer()
    assert pacer.delay_s(None, 0.0, 0.0) == 0.0
    assert pacer.delay_s(None, 0.001, 10.0) == 0.0


def test_an_idle_time_is_not_caught_up_with() -> None:
    pacer = Pacer()
    drive(pacer, 1.0, 0.001, wall_s=1.0)
    pacer.rest()
    assert pacer.delay_s(1.0, 100.0, 1.0) == 0.0
    assert pacer.delay_s(1.0, 100.0, 1.02) > 0.019


def test_a_robot_that_cannot_keep_its_pace_does_not_race_afterwards() -> None:
    pacer = Pacer()
    pacer.delay_s(1.0, 0.0, 0.0)
    pacer.delay_s(1.0, 10.0, 0.1)
    assert pacer.delay_s(1.0, 10.0, 0.2) > 0.09


@settings(deadline=None, max_examples=50)
@given(st.lists(st.floats(0.0, 10.0), min_size=20, max_size=20))
def test_slices_stay_within_their_bounds(costs: list[float]) -> None:
    pacer = Pacer()
    for cost in costs:
        assert SHORTEST_S <= pacer.slice_s(None) <= LONGEST_S
        assert pacer.slice_s(0.01) <= 0.01 * HORIZON_S
        pacer.took(cost, 1.0)


def test_slices_shrink_until_an_advance_fits_the_budget() -> None:
    pacer = Pacer()
    for _ in range(20):
        pacer.took(pacer.slice_s(None) * 0.2, pacer.slice_s(None))
    assert pacer.slice_s(None) * 0.2 <= 1.01 * WALL_BUDGET_S


def test_backoff_doubles_with_jitter_up_to_its_longest_and_starts_over() -> None:
    backoff = Backoff(random.Random(1), first_s=0.1, longest_s=1.0)
    for bound in (0.1, 0.2, 0.4, 0.8, 1.0, 1.0):
        assert bound / 2 <= backoff.next_s() <= bound
    backoff.reset()
    assert backoff.next_s() <= 0.1


def test_a_command_is_new_once_and_the_oldest_are_forgotten() -> None:
    memory = CommandMemory(capacity=2)
    assert [memory.is_new(each) for each in "aabab"] == [True, False, True, False, False]
    assert memory.is_new("c")
    assert not memory.is_new("b")
    assert memory.is_new("a")
