"""Routes that grow item by item: what each would cost more."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.itineraries import Allowed, find_itineraries, follow
from mend.fleet.scheduling.alns.plan import copy_plan, routes_cost
from mend.fleet.scheduling.alns.problem_arrays import Kept, problem_arrays
from mend.fleet.scheduling.alns.propagation import update
from mend.fleet.scheduling.alns.records import Integers, Records
from mend.fleet.scheduling.alns.repair import insert
from mend.fleet.scheduling.alns.routes import longest_chain, plan_of, routes_in
from mend.fleet.scheduling.alns.state import state_for
from mend.fleet.scheduling.partial_routes import items_in
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.rng import rng_from
from mend.fleet.scheduling.schedule import Route
from mend.fleet.scheduling.timing import TimedRoutes


class Bid(NamedTuple):
    """The marginal cost of an item, with the legs and the ends of its itinerary."""

    cost: float
    transfers: int
    legs: Integers
    ends: Records

    @property
    def robots(self) -> set[int]:
        """Who carries the item."""
        return {int(leg[0]) for leg in self.legs[: self.transfers + 1]}


class GrowingRoutes:
    """Routes of some of the items, to which others are added.

    `held`: by robot, how many of its first tasks nothing may be put before. `begun`: items whose
    pickup is the first task of this robot already, and nothing more of their way. `conflict`: why
    the routes cannot be timed as they are. Raises `BrokenItineraryError` where an item of the
    routes is not delivered.
    """

    def __init__(
        self,
        problem: Problem,
        routes: Sequence[Route],
        held: Sequence[int] | None = None,
        begun: Mapping[int, int] | None = None,
    ) -> None:
        self.problem = problem
        self.begun = dict(begun or {})
        kept = Kept([0] * len(problem.robots) if held is None else held, self.begun)
        self._arrays = problem_arrays(problem, longest_chain(routes), kept)
        self._state = state_for(self._arrays)
        self._rng = rng_from(np.random.default_rng(0))
        plan = plan_of(self._arrays, problem, routes)
        self._fits = update(self._arrays, plan, self._state.sweep)
        copy_plan(plan, self._state.current)
        whole = [item for item in items_in(routes) if item not in self.begun]
        self.conflict = None if self._fits else TimedRoutes(problem, routes, whole).conflict

    @property
    def routes(self) -> tuple[Route, ...]:
        """The routes as they are now."""
        return routes_in(self._arrays, self._state.current)

    def bid(self, item: int, *, transfers: bool = True) -> Bid | None:
        """The lowest marginal cost of an item that was found; None where it has no place."""
        direct = self._bid(item, Allowed(0, False, 0.0))
        if not transfers or self.problem.items[item].direct:
            return direct
        shared = self._bid(item, Allowed(self._arrays.chain, direct is None, 0.0))
        found = [bid for bid in (direct, shared) if bid is not None]
        return min(found, key=lambda bid: bid.cost, default=None)

    def award(self, item: int, bid: Bid) -> set[int]:
        """Put the item in for good; the robots for whom something else may fit now.

        They are those whose routes or times are others, and who waits for one of these at a
        transfer. Raises `ValueError` where its itinerary does not fit.
        """
        arrays, state = self._arrays, self._state
        state.found.leg[:], state.found.ends[:] = bid.legs, bid.ends
        copy_plan(state.current, state.trial)
        follows = follow(arrays, state.trial, state.found, item, bid.transfers)
        if not follows or not update(arrays, state.trial, state.sweep):
            raise ValueError(f"item {item} does not fit into the routes like that")
        changed = np.flatnonzero(state.trial.rows.version != state.current.rows.version)
        copy_plan(state.trial, state.current)
        self.begun.pop(item, None)
        return self._with_coupled(set(changed.tolist()))

    def _with_coupled(self, robots: set[int]) -> set[int]:
        """And who hands over to or takes over from one of the robots, and whoever does from those.

        Who is delayed at a transfer delays all that the other one does after it.
        """
        if not self._state.current.transfers.any():
            return robots
        carriers: dict[int, set[int]] = {}
        for robot, route in enumerate(self.routes):
            for task in route:
                carriers.setdefault(task.item, set()).add(robot)
        coupled, known = set(robots), 0
        while len(coupled) > known:
            known = len(coupled)
            for each in carriers.values():
                if each & coupled:
                    coupled |= each
        return coupled

    def still_lowest(self, item: int, bid: Bid, changed: set[int]) -> bool:
        """Whether a bid from before an award still holds: nothing else may fit for its robots, and
        none of those for whom it may would do it cheaper alone."""
        if bid.robots & changed:
            return False
        found = self._state.found
        direct = Allowed(0, False, 0.0)
        find_itineraries(self._arrays, self._state.current, found, self._rng, item, direct)
        known = int(found.known[0])
        rows, extra = found.last[:known, 1].tolist(), found.extra[:known].tolist()
        return all(
            row not in changed or price >= bid.cost for row, price in zip(rows, extra, strict=True)
        )

    def _bid(self, item: int, allowed: Allowed) -> Bid | None:
        arrays, state = self._arrays, self._state
        if not self._fits:
            return None
        copy_plan(state.current, state.trial)
        if not insert(arrays, state, self._rng, item, allowed):
            return None
        price = routes_cost(arrays, state.trial) - routes_cost(arrays, state.current)
        changes = int(state.trial.transfers[item])
        return Bid(price, changes, state.found.leg.copy(), state.found.ends.copy())
