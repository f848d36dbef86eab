"""Why the plan of a fleet became another one, and whom that touches."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager

from mend.fleet.dispatch.booking import PlanChange
from mend.fleet.scheduling.replanning.running_fleet import Outcome, RunningFleet
from mend.fleet.scheduling.schedule import Action

Doing = tuple[str, str]
"""An item, and what is done with it."""


class PlanLog:
    """The latest changes of a plan, numbered from 1; so many as are `kept`."""

    def __init__(self, kept: int) -> None:
        self._changes: deque[PlanChange] = deque(maxlen=kept)
        self.count = 0

    @property
    def changes(self) -> Sequence[PlanChange]:
        """The latest ones, the last of all last."""
        return tuple(self._changes)

    def restore(self, changes: Iterable[PlanChange], count: int) -> None:
        """What was kept, and how many there were."""
        self._changes.extend(changes)
        self.count = count

    @contextmanager
    def entry(
        self,
        fleet: Callable[[], RunningFleet],
        reason: str,
        requests: Iterable[str],
        *,
        own: str | None = None,
    ) -> Iterator[list[Outcome]]:
        """Note what becomes of the plan meanwhile, if anything does, or anything was said.

        `requests`: whom it touches in any case; `own`: what merely goes on.
        """
        before = _orders(fleet(), own)
        outcomes: list[Outcome] = []
        yield outcomes
        after = _orders(fleet(), own)
        said: dict[str, str] = {}
        for each in outcomes:
            for sentences in (each.late, each.refused, each.put_off, each.overtime):
                said.update(sentences)
        robots = sorted(name for name in before if before[name] != after.get(name))
        touched = {*requests, *said.keys() & fleet().items.keys()}
        touched |= set(_moved(before, after))
        if robots or said or touched:
            self.count += 1
            changing = _given(after) - _given(before)
            transfers = fleet().transfer_savings(sorted({item for _, item in changing}))
            change = PlanChange(
                self.count,
                fleet().now_s,
                reason,
                tuple(sorted(touched)),
                tuple(robots),
                said,
                transfers,
            )
            self._changes.append(change)


def _orders(fleet: RunningFleet, own: str | None) -> dict[str, list[Doing]]:
    return {
        robot: [(stop.item, stop.action) for stop in stops if stop.item != own]
        for robot, stops in fleet.stops().items()
    }


def _moved(before: dict[str, list[Doing]], after: dict[str, list[Doing]]) -> Iterator[str]:
    """The items with which other robots do other things than before."""
    was, now = (
        {(robot, *doing) for robot, doings in each.items() for doing in doings}
        for each in (before, after)
    )
    yield from (item for _, item, _ in was ^ now)


def _given(orders: dict[str, list[Doing]]) -> set[tuple[str, str]]:
    """Which robot leaves which item for another."""
    return {
        (robot, item)
        for robot, doings in orders.items()
        for item, action in doings
        if action == Action.GIVE
    }
