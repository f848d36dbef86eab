"""Routes that deliver some of the items: the problem with only those, and its schedule."""

from collections.abc import Container, Mapping, Sequence
from dataclasses import replace

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Route, Schedule
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule


def items_in(routes: Sequence[Route]) -> list[int]:
    """The items of the routes, in order."""
    return sorted({task.item for route in routes for task in route})


def without_items(routes: Sequence[Route], items: Container[int]) -> tuple[Route, ...]:
    """The routes without all tasks of some items."""
    return tuple(tuple(task for task in route if task.item not in items) for route in routes)


def renumbered(routes: Sequence[Route], number: Mapping[int, int]) -> tuple[Route, ...]:
    """The routes with other numbers for their items."""
    return tuple(tuple(replace(task, item=number[task.item]) for task in route) for route in routes)


def part_of(problem: Problem, routes: Sequence[Route]) -> tuple[Problem, tuple[Route, ...]]:
    """The problem with only the items of the routes, and the routes with its numbers."""
    kept = items_in(routes)
    part = replace(problem, items=tuple(problem.items[item] for item in kept))
    return part, renumbered(routes, {item: n for n, item in enumerate(kept)})


def part_schedule(problem: Problem, routes: Sequence[Route]) -> tuple[Problem, Schedule] | None:
    """The problem with only the items of the routes, and its schedule if the checker passes it.

    Times may fit and robots still wait for each other in a circle that takes no time.
    """
    part, own = part_of(problem, routes)
    schedule = earliest_schedule(part, own)
    if isinstance(schedule, Untimeable) or check(part, schedule):
        return None
    return part, schedule
