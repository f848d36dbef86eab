"""The methods that there are, by name, and which one suits a problem.

A method is added here: a solver with the signature of `Solver`, and what it can do.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from mend.fleet.scheduling.alns.solve import prepare as prepare_alns
from mend.fleet.scheduling.alns.solve import solve_alns
from mend.fleet.scheduling.auction import solve_by_auction
from mend.fleet.scheduling.cheapest_insertion import solve_by_insertion
from mend.fleet.scheduling.exact.route_bound import prepare as prepare_routes
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.nearest_next import solve_by_nearest_next
from mend.fleet.scheduling.one_destination import solve_to_one_destination
from mend.fleet.scheduling.one_task_bidder import solve_one_task_each
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, Status, UnsupportedError

Clock = Callable[[], float]
"""Tells seconds from whatever origin."""

EXACT_ITEMS = 12
"""Up to this many items the exact method is worth its time."""
WARM_UP_SHARE = 0.2
"""The share of the time that goes to heuristics before the exact method begins, at most."""
WARM_UP_S = 0.25
"""How much of it they need for each item (seconds): few items are soon as good as they get."""
LAST_SHARE = 0.1
"""The share of the time after it for what it has not proved: a search may still find better."""
EXACT_SIZE = 2_000_000
"""How large the exact model may be (robots times visits squared times items) to fit in memory."""


ALL_CHANGE = frozenset({"exact", "alns", "one_destination"})
"""Methods that would have any item change robots, also one that is `direct`."""


class Solver(Protocol):
    """Finds the best schedule that it can in about `seconds`; never worse than `start`."""

    def __call__(
        self,
        problem: Problem,
        *,
        seconds: float,
        seed: int,
        start: Schedule | None,
        on_progress: Callable[[Progress], None] | None,
        clock: Clock,
    ) -> Solution: ...


@dataclass(frozen=True, slots=True)
class Method:
    """A solver; whether it plans around doors that open and close; whether it proves bounds.

    `prepare` compiles it, or loads what was compiled before.
    """

    solve: Solver
    doors: bool
    proves: bool
    summary: str
    prepare: Callable[[], None] | None = None


def _exact_after_heuristics(
    problem: Problem,
    *,
    seconds: float,
    seed: int,
    start: Schedule | None,
    on_progress: Callable[[Progress], None] | None,
    clock: Clock,
) -> Solution:
    """The exact method from the best schedule that the heuristics have found.

    Where its model would be too large, their schedule is all that there is, without a bound.
    """
    began_s = clock()
    fits = _exact_size(problem) <= EXACT_SIZE
    warm_up_s = min(WARM_UP_SHARE * seconds, WARM_UP_S * len(problem.items))
    warm = best_heuristic(
        problem,
        seconds=warm_up_s if fits else seconds,
        seed=seed,
        start=start,
        on_progress=on_progress,
        clock=clock,
    )
    if not fits:
        return warm
    spent_s = clock() - began_s
    solution = solve_exactly(
        problem,
        seconds=max(0.1, (1 - LAST_SHARE) * (seconds - spent_s)),
        seed=seed,
        start=warm.schedule,
        on_progress=_later(on_progress, began_s, clock),
        clock=clock,
    )
    if solution.status in (Status.FEASIBLE, Status.UNKNOWN):
        last = solve_alns(
            problem,
            seconds=max(0.0, seconds - (clock() - began_s)),
            seed=seed,
            start=solution.schedule,
            on_progress=None,
            clock=clock,
        )
        if last.schedule is not None:
            solution = replace(
                solution, status=Status.FEASIBLE, schedule=last.schedule, cost=last.cost
            )
    status = solution.status
    # Incumbent and bound may differ by the rounding of the model alone.
    if solution.cost is not None and solution.gap == 0.0:
        status = Status.OPTIMAL
    return Solution(status, solution.schedule, solution.cost, solution.bound, clock() - began_s)


def _exact_size(problem: Problem) -> int:
    visits = 2 * len(problem.items) + len(problem.transfers.places) + 2
    return len(problem.robots) * visits**2 * max(1, len(problem.items))


def _prepare_exact() -> None:
    prepare_alns()
    prepare_routes()


METHODS: Mapping[str, Method] = {
    "exact": Method(
        _exact_after_heuristics, False, True, "optimal, or with a proved bound", _prepare_exact
    ),
    "alns": Method(solve_alns, True, False, "adaptive large neighbourhoods", prepare_alns),
    "auction": Method(solve_by_auction, True, False, "robots bid for each item", prepare_alns),
    "insertion": Method(
        solve_by_insertion, True, False, "each item where it costs least", prepare_alns
    ),
    "greedy": Method(
        solve_by_nearest_next, True, False, "each robot what it reaches first", prepare_alns
    ),
    "one_task": Method(solve_one_task_each, True, False, "one item at a time to who is done first"),
    "one_destination": Method(
        solve_to_one_destination,
        False,
        True,
        "at most twice the optimum, to one destination",
        prepare_alns,
    ),
}

HEURISTICS = ("greedy", "insertion", "auction", "alns")
"""What the exact method begins with, quickest first; the last one takes what time is left."""


def best_heuristic(
    problem: Problem,
    *,
    seconds: float,
    seed: int,
    start: Schedule | None,
    on_progress: Callable[[Progress], None] | None,
    clock: Clock,
) -> Solution:
    """The best of all heuristics, each of which begins with the best so far."""
    best = Solution(Status.UNKNOWN, start, None, None, 0.0)
    began_s = clock()
    for number, name in enumerate(HEURISTICS):
        left_s = max(0.0, seconds - (clock() - began_s))
        best = METHODS[name].solve(
            problem,
            seconds=left_s / (len(HEURISTICS) - number),
            seed=seed,
            start=best.schedule,
            on_progress=_later(on_progress, began_s, clock),
            clock=clock,
        )
    return best


def suited_method(problem: Problem) -> str:
    """The name of the method for a problem of this size and with these features."""
    small = len(problem.items) <= EXACT_ITEMS and not problem.travel.epochs
    return "exact" if small else "alns"


def solve(
    problem: Problem,
    method: str,
    *,
    seconds: float,
    seed: int = 0,
    on_progress: Callable[[Progress], None] | None = None,
    on_prepare: Callable[[], None] | None = None,
    clock: Clock,
) -> Solution:
    """Solve with a method by name, or `auto`.

    `on_prepare` is called before a method is compiled or loaded, which does not count as its time.
    Raises `KeyError` for a name that is none and `UnsupportedError` for a problem that the method
    cannot do.
    """
    name = suited_method(problem) if method == "auto" else method
    chosen = METHODS[name]
    if name in ALL_CHANGE and problem.transfers.places and any(i.direct for i in problem.items):
        able = ", ".join(sorted(METHODS.keys() - ALL_CHANGE))
        raise UnsupportedError(
            f"the method '{name}' cannot plan with items that may not change robots; {able} can"
        )
    if problem.travel.epochs and not chosen.doors:
        able = ", ".join(name for name, each in METHODS.items() if each.doors)
        raise UnsupportedError(
            f"the method '{method}' cannot plan with doors that open and close; {able} can"
        )
    if chosen.prepare is not None:
        if on_prepare is not None:
            on_prepare()
        chosen.prepare()
    return chosen.solve(
        problem, seconds=seconds, seed=seed, start=None, on_progress=on_progress, clock=clock
    )


def _later(
    tell: Callable[[Progress], None] | None, began_s: float, clock: Clock
) -> Callable[[Progress], None] | None:
    """Tell with the seconds since the beginning of everything."""
    if tell is None:
        return None
    return lambda each: tell(Progress(each.incumbent, each.bound, clock() - began_s))
