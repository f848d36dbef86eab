"""The checker: it passes what can be carried out and names everything that cannot."""

from dataclasses import replace

import pytest
from delivery_problems import HANDED_OVER, corridor, parcel

from mend.fleet.scheduling.checker import ScheduleError, check, require_valid
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Window
from mend.fleet.scheduling.schedule import Action, RobotSchedule, Schedule, Stop, Task
from mend.fleet.scheduling.timing import earliest_schedule

PROBLEM = corridor(items=(parcel(),))


def handed_over(problem: Problem = PROBLEM) -> Schedule:
    schedule = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(schedule, Schedule)
    return schedule


def with_stop(schedule: Schedule, robot: int, index: int, **fields: object) -> Schedule:
    stops = list(schedule.robots[robot].stops)
    stops[index] = replace(stops[index], **fields)  # type: ignore[arg-type]
    robots = list(schedule.robots)
    robots[robot] = replace(robots[robot], stops=tuple(stops))
    return Schedule(tuple(robots))


def test_valid_schedule_has_nothing_wrong_and_its_cost_is_recomputed() -> None:
    schedule = require_valid(PROBLEM, handed_over())
    found = cost(PROBLEM, schedule)
    assert (found.distance_m, found.robots, found.completion_s) == (80.0, 2, 40.0)
    assert found.makespan_s == 40.0
    assert schedule.transfers == 1


@pytest.mark.parametrize(
    ("robot", "index", "fields", "words"),
    [
        (0, 1, {"arrival_s": 5.0}, "left cannot be there to give parcel at 5 s"),
        (0, 0, {"begin_s": -1.0}, "left begins to pick parcel before it arrives"),
        (0, 0, {"departure_s": -2.0}, "left departs before it is done"),
        (1, 0, {"begin_s": 10.0}, "before it was given"),
    ],
)
def test_times_that_do_not_add_up(
    robot: int, index: int, fields: dict[str, float], words: str
) -> None:
    violations = check(PROBLEM, with_stop(handed_over(), robot, index, **fields))
    assert any(words in each for each in violations), violations


def violations_of(problem: Problem) -> list[str]:
    """What another problem has against the schedule made for `PROBLEM`."""
    return check(problem, handed_over())


def test_every_limit_is_checked() -> None:
    left, right = PROBLEM.robots
    item = PROBLEM.items[0]
    cases: list[tuple[Problem, str]] = [
        (replace(PROBLEM, robots=(replace(left, capacity=0.5), right)), "more than 0.5"),
        (replace(PROBLEM, robots=(replace(left, shift=Window(3.0)), right)), "before its shift"),
        (replace(PROBLEM, robots=(replace(left, shift=Window(0, 9.0)), right)), "after its shift"),
        (replace(PROBLEM, robots=(replace(left, max_duration_s=9.0), right)), "away for longer"),
        (replace(PROBLEM, transfers=Transfers((1,))), "which is no transfer place"),
        (replace(PROBLEM, items=(replace(item, max_on_board_s=9.0),)), "too long"),
        (replace(PROBLEM, items=(replace(item, pickup=Visit(1)),)), "at the wrong place"),
        (replace(PROBLEM, items=(replace(item, delivery=Visit(1)),)), "to the wrong place"),
        (
            replace(PROBLEM, items=(replace(item, pickup=Visit(0, Window(5.0))),)),
            "before 5 s",
        ),
        (
            replace(PROBLEM, items=(replace(item, delivery=Visit(4, Window(0.0, 39.0))),)),
            "after 39 s",
        ),
    ]
    for problem, words in cases:
        assert any(words in each for each in violations_of(problem)), (
            words,
            violations_of(problem),
        )


def test_item_without_a_delivery_is_named() -> None:
    nothing = Schedule((RobotSchedule((), 0.0, 0.0), RobotSchedule((), 0.0, 0.0)))
    with pytest.raises(ScheduleError, match="item 'parcel': it is picked up 0 times"):
        require_valid(PROBLEM, nothing)


def test_robots_that_wait_for_each_other_in_a_circle_are_named() -> None:
    """Each takes from the other before it gives; at one place this takes no time at all."""
    items = (parcel("x", 2, 2), parcel("y", 2, 2))
    robots = (Robot("left", 2, 2, 2.0), Robot("right", 2, 2, 2.0))
    problem = corridor(items=items, robots=robots)

    def stop(action: Action, item: int, partner: int | None = None) -> Stop:
        return Stop(Task(2, action, item, partner), 0.0, 0.0, 0.0)

    left = (
        stop(Action.PICK, 0), stop(Action.TAKE, 1, 1), stop(Action.GIVE, 0, 1), stop(Action.DROP, 1)
    )  # fmt: skip
    right = (
        stop(Action.PICK, 1), stop(Action.TAKE, 0, 0), stop(Action.GIVE, 1, 0), stop(Action.DROP, 0)
    )  # fmt: skip
    schedule = Schedule((RobotSchedule(left, 0.0, 0.0), RobotSchedule(right, 0.0, 0.0)))
    assert check(problem, schedule) == ["left, right wait for each other in a circle"]


def test_item_aboard_needs_no_pickup() -> None:
    aboard = Item("aboard", 1.0, Visit(0), Visit(1), aboard=1)
    problem = corridor(items=(aboard,))
    schedule = earliest_schedule(problem, ((), (Task(1, Action.DROP, 0),)))
    assert isinstance(schedule, Schedule)
    assert check(problem, schedule) == []


def test_item_that_may_not_change_robots_and_does_is_named() -> None:
    problem = corridor(items=(parcel(direct=True),))
    assert "item 'parcel' changes robots, which it may not" in check(problem, handed_over())
