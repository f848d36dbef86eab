"""From routes to times: earliest, coupled by transfers, or a reason why not."""

import pytest
from delivery_problems import HANDED_OVER, corridor, corridor_items, parcel
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.constraint import ConstraintKind
from mend.fleet.scheduling.itinerary import BrokenItineraryError
from mend.fleet.scheduling.problem import Item, Robot, Transfers, Visit, Window
from mend.fleet.scheduling.schedule import Action, Schedule, Task
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule


def test_taker_waits_for_the_giver() -> None:
    problem = corridor(items=(parcel(),), transfers=Transfers((2,), service_s=3.0))
    schedule = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(schedule, Schedule)
    give, take = schedule.robots[0].stops[1], schedule.robots[1].stops[0]
    assert (give.begin_s, give.departure_s) == (20.0, 23.0)
    assert (take.arrival_s, take.begin_s) == (20.0, 23.0)
    assert schedule.robots[1].stops[1].begin_s == 46.0
    assert check(problem, schedule) == []


def test_both_robots_are_there_when_a_transfer_is_face_to_face() -> None:
    robots = (Robot("left", 0, 0, 2.0), Robot("right", 4, 4, 2.0, Window(50.0)))
    problem = corridor(
        items=(parcel(),), robots=robots, transfers=Transfers((2,), together=True, service_s=3.0)
    )
    schedule = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(schedule, Schedule)
    assert schedule.robots[0].stops[1].begin_s == 70.0
    assert schedule.robots[0].stops[1].arrival_s == 20.0
    assert check(problem, schedule) == []


def test_reason_names_the_constraints_that_cannot_hold_together() -> None:
    late = Item("late", 1.0, Visit(0, Window(30.0)), Visit(4, Window(0.0, 60.0)))
    problem = corridor(items=(late,))
    reason = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(reason, Untimeable)
    kinds = {constraint.kind for constraint in reason.constraints}
    assert {ConstraintKind.WINDOW_BEGIN, ConstraintKind.WINDOW_END} <= kinds
    assert ConstraintKind.TRANSFER in kinds
    text = reason.sentence(problem)
    assert "nobody can pick late at a before 30 s" in text
    assert "to drop late at e must begin by 60 s" in text


def test_item_that_is_too_long_on_board_is_explained() -> None:
    problem = corridor(items=(parcel(max_on_board_s=39.0),))
    reason = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(reason, Untimeable)
    assert "parcel may be on board for 39 s" in reason.sentence(problem)


def test_way_that_breaks_is_told() -> None:
    problem = corridor(items=(parcel(),))
    with pytest.raises(BrokenItineraryError, match="right does not take it from left"):
        earliest_schedule(problem, (HANDED_OVER[0], ()))


@given(corridor_items(), st.randoms(use_true_random=False), st.booleans())
@settings(deadline=None)
def test_what_is_timed_passes_the_checker(items: tuple[Item, ...], chance, together) -> None:  # type: ignore[no-untyped-def]
    """Random routes with random transfers: either a valid schedule or a reason."""
    problem = corridor(
        items=items,
        robots=(Robot("left", 0, 0, 9.0), Robot("right", 4, None, 9.0, max_duration_s=300.0)),
        transfers=Transfers((1, 2), together=together, service_s=1.0),
    )
    routes: list[list[Task]] = [[], []]
    for number, item in enumerate(items):
        first, second = chance.sample([0, 1], 2)
        pick = Task(item.pickup.place, Action.PICK, number)
        drop = Task(item.delivery.place, Action.DROP, number)
        if chance.random() < 0.5:
            routes[first] += [pick, drop]
        else:
            place = chance.choice((1, 2))
            routes[first] += [pick, Task(place, Action.GIVE, number, second)]
            routes[second] += [Task(place, Action.TAKE, number, first), drop]
    timed = earliest_schedule(problem, [tuple(route) for route in routes])
    if isinstance(timed, Untimeable):
        assert timed.constraints
    else:
        violations = check(problem, timed)
        # Times alone do not see a circle that takes no time.
        assert [each for each in violations if "in a circle" not in each] == []
