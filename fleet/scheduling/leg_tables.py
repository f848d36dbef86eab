"""What each robot could do for an item on the route that it has: its cheapest legs, kept as long as
its times stay the same, and the graph of transfers that they make."""

from collections.abc import Sequence

import numpy as np

from mend.fleet.scheduling.leg_search import (
    FAR,
    Ends,
    Floats,
    Legs,
    Prices,
    RouteTimes,
    find_legs,
    no_legs,
)
from mend.fleet.scheduling.problem import Problem, Visit
from mend.fleet.scheduling.trajectories import TransferGraph

BEST_PLACES = 8
"""How many transfer places are tried for an item: those with the smallest detour."""
LEAST_PRICE = 1e-9
"""What a metre costs at least, so that of ways that cost nothing the shorter one is preferred."""


class LegTables:
    """The cheapest legs of robots for items, looked up again only where a robot's times changed.

    `carrier` of an item: the robot that must begin its way, from where it starts.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._distance_m = _finite(problem.travel.distance_m)
        self._time_s = _finite(problem.travel.time_s)
        self._fastest = max(robot.speed for robot in problem.robots)
        self._times: dict[int, tuple[int, RouteTimes]] = {}
        self._tables: dict[tuple[int, int, bool], tuple[int, Legs]] = {}

    def see(self, robot: int, times: RouteTimes) -> bool:
        """Take note of a robot's route and times; whether they are others than before."""
        known = self._times.get(robot)
        if known is not None and _same(known[1], times):
            return False
        self._times[robot] = (0 if known is None else known[0] + 1), times
        return True

    def graph(self, item: int, carrier: int | None, *, transfers: bool) -> TransferGraph:
        """The ways that an item could take over the robots' routes."""
        places = self._transfer_places(item, carrier) if transfers else []
        ends, prices = self._ends(item, carrier, places), self._prices(item)
        legs = [self._legs(item, carrier, robot, ends, prices) for robot in self._times]
        handling = self._problem.transfers
        return TransferGraph(legs, places, 0.0 if handling.together else handling.service_s)

    def alone(self, item: int, carrier: int | None, robot: int) -> float:
        """What it probably costs at least when that robot brings the item; infinite: it cannot."""
        ends = self._ends(item, carrier, ())
        legs = self._legs(item, carrier, robot, ends, self._prices(item))
        return float(legs.extra[0, 0, 0])

    def _legs(
        self, item: int, carrier: int | None, robot: int, ends: Ends, prices: Prices
    ) -> Legs:  # fmt: skip
        version, times = self._times[robot]
        key = (item, robot, len(ends.load_place) > 1)
        known = self._tables.get(key)
        if known is not None and known[0] == version:
            return known[1]
        legs = no_legs(len(ends.load_place))
        find_legs(
            self._distance_m, self._time_s, times, ends, prices,
            float(self._problem.items[item].load),
            carrier == robot, carrier in (None, robot), legs,
        )  # fmt: skip
        self._tables[key] = version, legs
        return legs

    def _transfer_places(self, item: int, carrier: int | None) -> list[int]:
        places = np.array(self._problem.transfers.places, dtype=np.intp)
        if len(self._problem.robots) < 2 or not len(places):
            return []
        origin = self._origin(item, carrier)
        destination = self._problem.items[item].delivery.place
        detours_m = self._distance_m[origin, places] + self._distance_m[places, destination]
        nearest = np.argsort(detours_m, kind="stable")[:BEST_PLACES]
        return [int(place) for place in places[nearest[detours_m[nearest] < FAR]]]

    def _origin(self, item: int, carrier: int | None) -> int:
        if carrier is not None:
            return self._problem.robots[carrier].start
        return self._problem.items[item].pickup.place

    def _ends(self, item: int, carrier: int | None, places: Sequence[int]) -> Ends:
        visits, handling = self._problem.items[item], self._problem.transfers
        origin, goal = self._origin(item, carrier), visits.delivery
        pickup = visits.pickup if carrier is None else Visit(origin)
        begin_s = pickup.window.earliest_s + pickup.service_s
        over = list(places)
        given_from = begin_s + self._time_s[origin, over] / self._fastest
        until = goal.window.latest_s - self._time_s[over, goal.place] / self._fastest
        until -= handling.service_s
        wait_s = 0.0 if handling.together else handling.service_s
        service = [handling.service_s] * len(over)
        return Ends(
            load_place=np.array([origin, *over], dtype=np.int64),
            load_s=np.array([pickup.service_s, *service]),
            load_from_s=np.array([pickup.window.earliest_s, *(given_from + wait_s)]),
            load_until_s=np.array([pickup.window.latest_s, *until]),
            unload_place=np.array([goal.place, *over], dtype=np.int64),
            unload_s=np.array([goal.service_s, *service]),
            unload_from_s=np.array([goal.window.earliest_s, *given_from]),
            unload_until_s=np.array([goal.window.latest_s, *(until - wait_s)]),
        )

    def _prices(self, item: int) -> Prices:
        weights = self._problem.weights
        return Prices(
            metre=float(weights.distance + weights.makespan) or LEAST_PRICE,
            second=float(weights.completion),
            late_second=float(weights.lateness),
            due_s=float(self._problem.items[item].delivery.due_s),
            robot=float(weights.robots),
        )


def _finite(matrix: Floats) -> Floats:
    return np.ascontiguousarray(np.where(np.isfinite(matrix), matrix, FAR))


def _same(first: RouteTimes, second: RouteTimes) -> bool:
    return first.end_latest_s == second.end_latest_s and all(
        np.array_equal(getattr(first, name), getattr(second, name))
        for name in ("place", "begin_s", "latest_s")
    )
