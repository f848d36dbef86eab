"""Why items that could each be delivered cannot all be: an infeasible subset that no smaller one is
part of, and the constraints that do not hold together. What is left out is proved not to be needed.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, isfinite

from mend.fleet.scheduling.constraint import Constraint, ConstraintKind, sentence
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.problem import Item, Problem, Robot, Weights, Window
from mend.fleet.scheduling.schedule import Action, Task
from mend.fleet.scheduling.solution import Status

ANYTHING = Weights(distance=0.0, lateness=0.0)
"""Costs with which any schedule is as good as another: only whether there is one counts."""
PROOF_SHARE = 0.25
"""The most of the time left for one proof, so that a hard one does not take the others' time."""


@dataclass(frozen=True, slots=True)
class Limit:
    """One constraint in words, and the problem without it."""

    words: str
    lifted: Callable[[Problem], Problem]


def infeasible_subset_words(problem: Problem, *, seconds: float, clock: Callable[[], float]) -> str:
    """One sentence for a problem that is proved infeasible.

    Where the time is over before everything was tried, it may name more than is in the subset.
    """
    began_s = clock()

    def infeasible(candidate: Problem) -> bool:
        left_s = seconds - (clock() - began_s)
        if left_s <= 0:
            return False
        found = solve_exactly(candidate, seconds=PROOF_SHARE * left_s, clock=clock)
        return found.status is Status.INFEASIBLE

    core = _fewest_items(replace(problem, weights=ANYTHING), infeasible)
    limits = _binding_limits(core, infeasible)
    names = [f"'{item.name}'" for item in core.items]
    who = f"items {', '.join(names[:-1])} and {names[-1]}" if names[1:] else f"item {names[0]}"
    what = "cannot all be delivered" if names[1:] else "cannot be delivered"
    how = f"{who} {what}, whatever the robots do"
    if not limits:
        return f"{how}: the ways between the places do not allow it"
    return f"{how}; these cannot hold together: {'; '.join(limit.words for limit in limits)}"


def _fewest_items(problem: Problem, infeasible: Callable[[Problem], bool]) -> Problem:
    """The problem with an infeasible subset of its items; halves go first, then one by one."""
    items, size = problem.items, len(problem.items) // 2
    while size > 0:
        at = 0
        while at < len(items) and len(items) > 1:
            fewer = items[:at] + items[at + size :]
            if fewer and infeasible(replace(problem, items=fewer)):
                items = fewer
            else:
                at += size
        size //= 2
    return replace(problem, items=items)


def _binding_limits(problem: Problem, infeasible: Callable[[Problem], bool]) -> list[Limit]:
    """The constraints without any one of which the others can hold."""
    binding = []
    for limit in _limits(problem):
        without = limit.lifted(problem)
        if infeasible(without):
            problem = without
        else:
            binding.append(limit)
    return binding


def _limits(problem: Problem) -> Iterator[Limit]:
    for number, item in enumerate(problem.items):
        if isfinite(item.pickup.window.latest_s) and item.aboard is None:
            task = Task(item.pickup.place, Action.PICK, number)
            yield Limit(_ends(problem, task), _without(number, _any_pickup_time))
        if isfinite(item.delivery.window.latest_s):
            task = Task(item.delivery.place, Action.DROP, number)
            yield Limit(_ends(problem, task), _without(number, _any_delivery_time))
        if isfinite(item.max_on_board_s):
            task = Task(item.delivery.place, Action.DROP, number)
            words = sentence(problem, Constraint(ConstraintKind.ON_BOARD, None, task))
            yield Limit(words, _without(number, _any_time_on_board))
    whole = sum(item.load for item in problem.items)
    for number, robot in enumerate(problem.robots):
        if isfinite(robot.shift.latest_s):
            words = sentence(problem, Constraint(ConstraintKind.SHIFT_END, number))
            yield Limit(words, _with_robot(number, _endless_shift))
        if isfinite(robot.max_duration_s):
            words = sentence(problem, Constraint(ConstraintKind.DURATION, number))
            yield Limit(words, _with_robot(number, _any_duration))
        if robot.capacity < whole:
            words = f"{robot.name} carries no more than {robot.capacity:g}"
            yield Limit(words, _with_robot(number, lambda each: replace(each, capacity=whole)))


def _ends(problem: Problem, task: Task) -> str:
    return sentence(problem, Constraint(ConstraintKind.WINDOW_END, None, task))


def _without(number: int, lifted: Callable[[Item], Item]) -> Callable[[Problem], Problem]:
    def change(problem: Problem) -> Problem:
        items = list(problem.items)
        items[number] = lifted(items[number])
        return replace(problem, items=tuple(items))

    return change


def _with_robot(number: int, lifted: Callable[[Robot], Robot]) -> Callable[[Problem], Problem]:
    def change(problem: Problem) -> Problem:
        robots = list(problem.robots)
        robots[number] = lifted(robots[number])
        return replace(problem, robots=tuple(robots))

    return change


def _open(window: Window) -> Window:
    return replace(window, latest_s=inf)


def _any_pickup_time(item: Item) -> Item:
    return replace(item, pickup=replace(item.pickup, window=_open(item.pickup.window)))


def _any_delivery_time(item: Item) -> Item:
    return replace(item, delivery=replace(item.delivery, window=_open(item.delivery.window)))


def _any_time_on_board(item: Item) -> Item:
    return replace(item, max_on_board_s=inf)


def _endless_shift(robot: Robot) -> Robot:
    return replace(robot, shift=_open(robot.shift))


def _any_duration(robot: Robot) -> Robot:
    return replace(robot, max_duration_s=inf)
