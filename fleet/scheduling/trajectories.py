"""An item's whole trajectory through a graph of transfers: robots carry it from place to place.

Nodes are the transfer places with who brought the item there; edges are the cheapest legs of every
robot along the route that it has. Trajectories come out of it cheapest first.
"""

import heapq
from collections.abc import Iterator, Sequence
from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.leg_search import KEPT, Floats, Integers, Legs

CHAIN = 3
"""The most transfers of one item."""
BEST_LEGS = 6
"""How many legs to a place, and how many from it to the delivery, are followed."""
BEST_LINKS = 2
"""How many legs are followed from one transfer place to another one."""
MOST = 40
"""How many trajectories with transfers are looked at."""


class Leg(NamedTuple):
    """A robot loads the item before its task number `load_at` (None: it has it) and unloads it
    before its task number `unload_at`."""

    robot: int
    load_at: int | None
    unload_at: int


class Trajectory(NamedTuple):
    """Legs with the transfer places between them; `added` is what they probably cost."""

    added: float
    added_m: float
    legs: tuple[Leg, ...]
    places: tuple[int, ...]


class _Part(NamedTuple):
    """One leg with its estimates."""

    extra: float
    metres: float
    leg: Leg
    ready_s: float
    wanted_s: float


class TransferGraph:
    """The legs of all robots for one item; `places` are the transfer places by end, from 1."""

    def __init__(self, legs: Sequence[Legs], places: Sequence[int], handling_s: float) -> None:
        self._legs = legs
        self._places = places
        self._handling_s = handling_s

    def direct(self) -> list[Trajectory]:
        """Every trajectory without a transfer that is known, cheapest first."""
        return [
            Trajectory(part.extra, part.metres, (part.leg,), ())
            for part in self._parts(0, 0, len(self._legs) * KEPT, inf)
        ]

    def handed_over(self, limit: float) -> Iterator[Trajectory]:
        """The trajectories with transfers that cost less than `limit`, cheapest first."""
        ends = range(1, len(self._places) + 1)
        last = {end: self._parts(end, 0, BEST_LEGS, limit) for end in ends}
        least = {end: parts[0].extra if parts else inf for end, parts in last.items()}
        links = {
            (end, other): self._parts(end, other, BEST_LINKS, limit)
            for end in ends
            for other in ends
            if end != other and CHAIN > 1
        }
        # What has been spent, then a number so that nothing else is compared.
        waiting: list[tuple[float, int, int, tuple[_Part, ...], tuple[int, ...]]] = []
        count = 0
        for end in ends:
            for part in self._parts(0, end, BEST_LEGS, limit - least[end]):
                count += 1
                waiting.append((part.extra, count, end, (part,), (end,)))
        heapq.heapify(waiting)
        yielded = 0
        while waiting and yielded < MOST:
            spent, _, end, parts, ends_so_far = heapq.heappop(waiting)
            if end == 0:
                yielded += 1
                yield self._trajectory(spent, parts, ends_so_far)
                continue
            onward = [(part, 0) for part in last[end]]
            if len(parts) < CHAIN:
                onward += [
                    (part, other)
                    for other in ends
                    if other not in ends_so_far
                    for part in links[end, other]
                    if spent + part.extra + least[other] < limit
                ]
            for part, target in onward:
                if spent + part.extra < limit and self._fits(parts, part):
                    count += 1
                    then = ends_so_far if target == 0 else (*ends_so_far, target)
                    heapq.heappush(
                        waiting, (spent + part.extra, count, target, (*parts, part), then)
                    )

    def _parts(self, origin: int, target: int, most: int, limit: float) -> list[_Part]:
        """The cheapest legs of all robots between two ends."""
        extra: Floats = np.array([legs.extra[origin, target] for legs in self._legs]).ravel()
        nearest: Integers = np.argsort(extra, kind="stable")[:most]
        parts = []
        for number in nearest.tolist():
            if not extra[number] < limit:
                break
            robot, rank = divmod(number, KEPT)
            legs, at = self._legs[robot], (origin, target, rank)
            load_at = int(legs.load_at[at])
            leg = Leg(robot, None if load_at < 0 else load_at, int(legs.unload_at[at]))
            parts.append(
                _Part(
                    float(extra[number]), float(legs.metres[at]), leg,
                    float(legs.ready_s[at]), float(legs.wanted_s[at]),
                )
            )  # fmt: skip
        return parts

    def _fits(self, parts: tuple[_Part, ...], part: _Part) -> bool:
        """Whether another robot takes the item, in time for what it does then."""
        given_s = parts[-1].ready_s + self._handling_s
        return given_s <= part.wanted_s + 1e-6 and all(
            each.leg.robot != part.leg.robot for each in parts
        )

    def _trajectory(
        self, added: float, parts: tuple[_Part, ...], ends: tuple[int, ...]
    ) -> Trajectory:
        return Trajectory(
            added,
            sum(part.metres for part in parts),
            tuple(part.leg for part in parts),
            tuple(self._places[end - 1] for end in ends),
        )
