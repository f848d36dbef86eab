"""Why items cannot all be delivered although each of them could: found by leaving things away.

The exact method proves what remains impossible, so it takes time; what is said is certain.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf

from fleet.scheduling.exact.solve import solve_exactly
from fleet.scheduling.problem import Problem, Robot, Visit, Window
from fleet.scheduling.solution import Status

Clock = Callable[[], float]


@dataclass(frozen=True, slots=True)
class JointContradiction:
    """Items that cannot all be delivered, and the limits each of which is in the way.

    `smallest`: any of the items left away, the others can be delivered. `limits` is empty where
    lifting one kind of them is not enough, or it was not found out in time.
    """

    items: tuple[int, ...]
    smallest: bool
    limits: tuple[str, ...]


def joint_contradiction(
    problem: Problem, *, seconds: float, seed: int = 0, clock: Clock
) -> JointContradiction:
    """The fewest items of an infeasible problem that cannot all be delivered.

    The problem has to be proved infeasible already, without doors; takes about `seconds`.
    """
    ends_s = clock() + seconds

    def status(changed: Problem, share: float) -> Status:
        limit_s = max(0.1, (ends_s - clock()) * share)
        return solve_exactly(changed, seconds=limit_s, seed=seed).status

    kept, smallest = list(range(len(problem.items))), True
    for item in range(len(problem.items)):
        without = [each for each in kept if each != item]
        if not without:
            break
        match status(_with_items(problem, without), 0.5):
            case Status.INFEASIBLE:
                kept = without
            case Status.UNKNOWN:
                smallest = False
    least = _with_items(problem, kept)
    limits = tuple(words for words, lifted in _lifted(least) if _can_be_done(status(lifted, 0.5)))
    return JointContradiction(tuple(kept), smallest, limits)


def in_words(problem: Problem, found: JointContradiction) -> str:
    """One sentence about what cannot hold together."""
    names = [f"'{problem.items[each].name}'" for each in found.items]
    if len(names) == 1:
        sentence = f"item {names[0]} cannot be delivered"
    else:
        all_of = "both" if len(names) == 2 else "all"
        sentence = f"items {', '.join(names[:-1])} and {names[-1]} cannot {all_of} be delivered"
        if found.smallest:
            sentence += ", though all but any one of them could"
    if not found.limits:
        return f"{sentence}: more than one kind of limit is in the way"
    return f"{sentence}: it would take {' or '.join(found.limits)}"


def _can_be_done(status: Status) -> bool:
    return status in (Status.OPTIMAL, Status.FEASIBLE)


def _with_items(problem: Problem, kept: list[int]) -> Problem:
    return replace(problem, items=tuple(problem.items[each] for each in kept))


def _lifted(problem: Problem) -> Iterator[tuple[str, Problem]]:
    """The problem without one kind of its limits, and what that would mean."""
    robots, items = problem.robots, problem.items
    relaxed = {
        "more capacity": _robots(problem, lambda each: replace(each, capacity=inf)),
        "longer shifts (shift_s)": _robots(problem, lambda each: replace(each, shift=Window())),
        "more time away (max_duration_s)": _robots(
            problem, lambda each: replace(each, max_duration_s=inf)
        ),
        "wider windows (window_s)": replace(
            problem,
            items=tuple(
                replace(each, pickup=_any_time(each.pickup), delivery=_any_time(each.delivery))
                for each in items
            ),
        ),
        "longer times on board (max_on_board_s)": replace(
            problem, items=tuple(replace(each, max_on_board_s=inf) for each in items)
        ),
    }
    if len(robots) > 1 and not problem.transfers.places:
        anywhere = replace(problem.transfers, places=tuple(range(len(problem.places))))
        relaxed["transfers between robots"] = replace(problem, transfers=anywhere)
    yield from ((words, each) for words, each in relaxed.items() if each != problem)


def _robots(problem: Problem, change: Callable[[Robot], Robot]) -> Problem:
    return replace(problem, robots=tuple(change(each) for each in problem.robots))


def _any_time(visit: Visit) -> Visit:
    return replace(visit, window=Window())
