"""The sentence for an item that has no place beside what the robots have to do already."""

from collections.abc import Callable, Mapping, Sequence

from mend.fleet.scheduling.auction import sell
from mend.fleet.scheduling.constraint import Constraint
from mend.fleet.scheduling.partial_routes import items_in
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Route
from mend.fleet.scheduling.temporal_network import Conflict
from mend.fleet.scheduling.timing import TimedRoutes, Untimeable


def conflict_words(problem: Problem, conflict: Conflict[Constraint]) -> str:
    """Which constraints cannot hold together."""
    return Untimeable(conflict.reasons).sentence(problem)


def no_place_words(problem: Problem, item: int, conflict: Conflict[Constraint] | None) -> str:
    """Why an item has no place; without a conflict nobody has room for it."""
    name = problem.items[item].name
    if conflict is None:
        return (
            f"item '{name}' has no place: no robot has room for it on its way "
            "beside what it has to do already"
        )
    return (
        f"item '{name}' has no place in time beside what the robots have to do "
        f"already: {conflict_words(problem, conflict)}"
    )


def left_over_words(problem: Problem, *, seconds: float, clock: Callable[[], float]) -> str | None:
    """Why one of the items that an auction cannot sell has no place; None where it sells them all,
    or the time is over. Another schedule may have a place for it: nothing is proved."""
    began_s = clock()
    routes = ((),) * len(problem.robots)
    items = range(len(problem.items))
    sale = sell(problem, routes, items, goes_on=lambda: clock() - began_s < seconds)
    if clock() - began_s >= seconds:
        return None
    conflicts = nearest_conflicts(problem, sale.routes, sale.unsold, {})
    found = [(item, why) for item, why in conflicts.items() if why is not None]
    return no_place_words(problem, *found[0]) if found else None


def nearest_conflicts(
    problem: Problem, routes: Sequence[Route], items: Sequence[int], begun: Mapping[int, int]
) -> dict[int, Conflict[Constraint] | None]:
    """By item the least of what breaks where a robot does it after all else, over all robots.

    None where load and ways alone forbid it. The routes have none of the items but the pickups of
    those that are `begun`, each with its robot. Raises `BrokenItineraryError`.
    """
    nearest: dict[int, Conflict[Constraint] | None] = dict.fromkeys(items)
    if not nearest:
        return nearest
    whole = [item for item in items_in(routes) if item not in begun]
    timed = TimedRoutes(problem, routes, whole, homeward=False)
    for robot, described in enumerate(problem.robots):
        with timed.trial():
            for other in range(len(problem.robots)):
                if other != robot:
                    timed.go_home(other)
            for item in items:
                carrier = begun.get(item, problem.items[item].aboard)
                if carrier in (None, robot) and problem.items[item].load <= described.capacity:
                    conflict = _conflict_at_the_end(timed, robot, item)
                    nearest[item] = _lesser(nearest[item], conflict)
    return nearest


def _conflict_at_the_end(timed: TimedRoutes, robot: int, item: int) -> Conflict[Constraint] | None:
    with timed.trial():
        timed.append(robot, item)
        timed.go_home(robot)
        timed.wait_for_doors()
        return timed.conflict


def _lesser(
    one: Conflict[Constraint] | None, other: Conflict[Constraint] | None
) -> Conflict[Constraint] | None:
    if one is None or other is None:
        return one or other
    return one if one.excess_s <= other.excess_s else other
