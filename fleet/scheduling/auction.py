"""The auction: robots bid for items what these cost them more, alone or over a transfer.

Round by round every item that is left gets its lowest bid, and the lowest of all is awarded.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from random import Random

from mend.fleet.scheduling.growing_routes import Bid, GrowingRoutes
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import part_schedule
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Route, Schedule
from mend.fleet.scheduling.solution import Progress, Solution, unproved

ATTEMPTS = 8
"""How many auctions are held, with transfers and without: each offers first what had no place."""
FEW = 24
"""Up to this many items are offered all at once; of more, in lots of this size, urgent ones first,
as the bids grow with the square of how many are on offer."""


@dataclass(frozen=True, slots=True)
class Sale:
    """The routes after an auction; the items that got no bid, or were not offered in time."""

    routes: tuple[Route, ...]
    unsold: tuple[int, ...] = ()


def sell(
    problem: Problem,
    routes: Sequence[Route],
    items: Sequence[int],
    *,
    held: Sequence[int] | None = None,
    begun: Mapping[int, int] | None = None,
    transfers: bool = True,
    goes_on: Callable[[], bool] = lambda: True,
) -> Sale:
    """Auction items to robots that have routes already, the cheapest item first.

    `held`: by robot, how many of its first tasks nothing may be put before; `begun`: items whose
    pickup is the first task of this robot already. Raises `ValueError` where the routes cannot be
    timed as they are.
    """
    growing = GrowingRoutes(problem, routes, held, begun)
    if growing.conflict is not None:
        raise ValueError("the routes have a conflict before anything is sold")
    carried = [n for n in items if n in growing.begun or problem.items[n].aboard is not None]
    left = carried + [item for item in items if item not in carried]
    unsold: list[int] = []
    bids: dict[int, Bid] = {}
    while left and goes_on():
        # What is on board takes up room until it is sold.
        lot = [item for item in left if item in carried] or left[:FEW]
        for item in lot:
            bid = bids.get(item) or growing.bid(item, transfers=transfers)
            if bid is None:
                # Whoever has no place now will have none when there is more to do.
                unsold.append(item)
                left.remove(item)
            else:
                bids[item] = bid
        if bids:
            item = min(bids, key=lambda each: (bids[each].cost, each))
            changed = growing.award(item, bids.pop(item))
            left.remove(item)
            bids = {n: bid for n, bid in bids.items() if growing.still_lowest(n, bid, changed)}
    return Sale(growing.routes, (*unsold, *left))


def solve_by_auction(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """The best schedule of several auctions, without transfers too; never worse than `start`.

    `clock` tells seconds; status `UNKNOWN` where no auction sold everything in time.
    """
    chance, began_s = Random(seed), clock()
    best, best_cost = start, inf if start is None else cost(problem, start).total
    kinds = (False, True) if problem.transfers.places else (False,)
    first: dict[bool, list[int]] = {kind: _aboard(problem) for kind in kinds}
    for attempt in range(ATTEMPTS * len(kinds)):
        kind = kinds[attempt % len(kinds)]
        if clock() - began_s >= seconds:
            break
        sale = _auction(problem, first[kind], kind, lambda: clock() - began_s < seconds)
        timed = None if sale.unsold else part_schedule(problem, sale.routes)
        if timed is not None and cost(problem, timed[1]).total < best_cost:
            best, best_cost = timed[1], cost(problem, timed[1]).total
            if on_progress is not None:
                on_progress(Progress(best_cost, None, clock() - began_s))
        first[kind] = _next_first(problem, first[kind], sale.unsold, chance)
    return unproved(problem, best, clock() - began_s)


def _auction(
    problem: Problem, first: Sequence[int], transfers: bool, goes_on: Callable[[], bool]
) -> Sale:
    """Sell some items one after the other, then all others at once."""
    sale = Sale(((),) * len(problem.robots))
    urgent = sorted(
        set(range(len(problem.items))) - set(first),
        key=lambda item: (problem.items[item].delivery.window.latest_s, item),
    )
    for lot in (*([item] for item in first), urgent):
        more = sell(problem, sale.routes, lot, transfers=transfers, goes_on=goes_on)
        sale = Sale(more.routes, sale.unsold + more.unsold)
    return sale


def _aboard(problem: Problem) -> list[int]:
    return [number for number, item in enumerate(problem.items) if item.aboard is not None]


def _next_first(
    problem: Problem, first: Sequence[int], unsold: Sequence[int], chance: Random
) -> list[int]:
    """What is offered first next time: what had no place, or some items by chance."""
    aboard = _aboard(problem)
    if not unsold:
        others = [n for n in range(len(problem.items)) if n not in aboard]
        return aboard + chance.sample(others, min(len(others), 1 + len(others) // 4))
    kept = [item for item in first if item not in aboard and item not in unsold]
    return aboard + [item for item in unsold if item not in aboard] + kept
