"""What is on and under a part at one time, in any order that a tree allows."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from mend.robots.arm.feasibility.moments import Job
from mend.robots.arm.feasibility.stability import stability_rad
from mend.robots.arm.feasibility.standing import Standing, beneath, resting_on
from mend.tasks.leaf_order import LeafOrder

_MOST_STATES = 100
"""So many sets of leaves that may be done are looked at, those of fewest leaves first."""


@dataclass(frozen=True)
class Burdens:
    """What the leaves of a tree bring onto parts, and under them."""

    jobs: Sequence[Job]
    starts: Sequence[Standing]
    order: LeafOrder
    mass_kg: Mapping[str, float]

    def around(self, standing: Standing, job: Job | None) -> list[Standing]:
        """What else stands there when a part stands least firmly.

        `job` is the one that places it, None where it starts.
        """
        others = [each for each in self._all if each.name != standing.name]
        stack = _stack(standing, others)
        worlds = [
            [each for each in others if each not in stack or self._is_there(each, done)]
            for done in _Leaves(self.jobs, self.order, standing, stack, job).done_at_some_time()
        ]
        carried = [each for each in worlds if beneath(standing, each)]
        return min(
            carried or worlds,
            key=lambda each: stability_rad(standing, beneath(standing, each), each, self.mass_kg),
        )

    @cached_property
    def _all(self) -> list[Standing]:
        places = [each.place for each in self.jobs if each.place is not None]
        return list(dict.fromkeys([*self.starts, *places]))

    def _is_there(self, standing: Standing, done: frozenset[int]) -> bool:
        if standing in self.starts:
            return not any(each.leaf in done for each in self.jobs if each.name == standing.name)
        return any(each.leaf in done for each in self.jobs if each.place == standing)


def _stack(standing: Standing, others: Sequence[Standing]) -> list[Standing]:
    """What may be on a part at some time, and what may carry that, or the part, besides."""
    above = resting_on(standing, others)
    under = [low for each in (standing, *above) for low in beneath(each, others)]
    return list(dict.fromkeys([*above, *under]))


class _Leaves:
    """The leaves that have to do with what a part stands on, and with what stands on it."""

    def __init__(
        self,
        jobs: Sequence[Job],
        order: LeafOrder,
        standing: Standing,
        stack: Sequence[Standing],
        job: Job | None,
    ) -> None:
        names = {each.name for each in stack}
        self._order = order
        self._own = None if job is None else job.leaf
        movers = {each.leaf for each in jobs if each.name == standing.name}
        self._leaves = [each.leaf for each in jobs if each.name in names]
        self._needed = {*self._leaves, *movers}

    def done_at_some_time(self) -> list[frozenset[int]]:
        """Which of them may be done while the part is where it is, fewest first, and all."""
        first = frozenset[int]()
        if self._own is not None:
            first = frozenset({self._own, *self._surely_before(self._own)})
        found = {first: None}
        waiting = [first]
        for done in waiting:
            more = [done | {leaf} for leaf in self._next(done)]
            new = [each for each in more if each not in found][: _MOST_STATES - len(found)]
            found.update(dict.fromkeys(new))
            waiting += new
        most = first
        while (leaf := next(self._next(most), None)) is not None:
            most |= {leaf}
        return [each for each in dict.fromkeys([*found, most]) if self._is_possible(each)]

    def _surely_before(self, leaf: int) -> set[int]:
        return {each for each in self._needed if self._order.is_before(each, leaf)}

    def _next(self, done: frozenset[int]) -> Iterator[int]:
        """The leaves that may be done after some, as far as is sure."""
        for leaf in self._leaves:
            excluded = any(self._order.exclusive(leaf, each) for each in done)
            if leaf not in done and not excluded and self._surely_before(leaf) <= done:
                yield leaf

    def _is_possible(self, done: frozenset[int]) -> bool:
        """Whether of alternatives before a leaf that is done one is done, where all are known."""
        return all(
            before in done or any(self._order.exclusive(before, each) for each in done)
            for leaf in done
            for before in self._needed
            if self._order.is_before(before, leaf, surely=False)
            and self._order.others_do(before, leaf, self._needed)
        )
