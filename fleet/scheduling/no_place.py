"""The sentence for an item that has no place beside what the robots have to do already."""

from collections.abc import Callable

from mend.fleet.scheduling.auction import sell
from mend.fleet.scheduling.constraint import Constraint, sentence
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.temporal_network import Conflict


def conflict_words(problem: Problem, conflict: Conflict[Constraint]) -> str:
    """Which constraints cannot hold together."""
    words = "; ".join(sentence(problem, each) for each in conflict.reasons)
    return f"these cannot hold together: {words}"


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
    found = [(item, why) for item, why in sale.unsold.items() if why is not None]
    return no_place_words(problem, *found[0]) if found else None
