"""How far requests have come and when they are expected, for whoever asked."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from mend.fleet.dispatch.booking import Booking, Expected, RequestView
from mend.fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from mend.fleet.scheduling.replanning.live_plan import NextStop
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.schedule import Action
from mend.fleet.scheduling.tolerance import CHECK_S


class ExpectedStop(NamedTuple):
    """Who is to do what, `late_s` later than the plan has it, as it is not done yet."""

    robot: str
    stop: NextStop
    late_s: float

    @property
    def begins_s(self) -> float:
        """When it is begun at the earliest."""
        return self.stop.begin_s + self.late_s

    @property
    def lasts_s(self) -> float:
        """How long what is to be done there takes."""
        return self.stop.done_s - self.stop.begin_s


Stops = Mapping[str, Sequence[ExpectedStop]]
"""By booking, who is to do what for it, as it is to be begun."""


def stops_by_booking(fleet: RunningFleet, now_s: float | None = None) -> Stops:
    """What is still to be done for each booking, by whom, at a time (None: of the last event)."""
    now_s = fleet.now_s if now_s is None else max(now_s, fleet.now_s)
    found: dict[str, list[ExpectedStop]] = {}
    for robot, stops in fleet.stops().items():
        for each in _as_late_as_it_is(fleet, robot, stops, now_s):
            found.setdefault(each.stop.item, []).append(each)
    return {name: sorted(stops, key=lambda each: each.begins_s) for name, stops in found.items()}


def view_of(booking: Booking, stops: Stops) -> RequestView:
    """One request as it is then."""
    mine = stops.get(booking.name, ())
    expected = _expected(mine, is_visit=booking.request.is_visit) if booking.open else None
    return RequestView(booking.name, booking.request, booking.status, booking.reason, expected)


def _expected(mine: Sequence[ExpectedStop], *, is_visit: bool) -> Expected | None:
    if not mine:
        return None
    first, last = mine[0], mine[0 if is_visit else -1]
    done_s = first.begins_s + first.lasts_s
    for each in mine[1 : mine.index(last) + 1]:
        # What is late with one robot is later with the next.
        done_s = max(done_s, each.begins_s) + each.lasts_s
    late_s = done_s - last.stop.done_s
    late_s = late_s if late_s > CHECK_S else 0.0
    return Expected(first.robot, first.stop.place, first.begins_s, done_s, late_s)


def _as_late_as_it_is(
    fleet: RunningFleet, robot: str, stops: Sequence[NextStop], now_s: float
) -> Iterator[ExpectedStop]:
    """What has not happened yet is not before now, and what follows is as much later.

    That is what the plan says as well, as soon as it is told of the time.
    """
    if not stops:
        return
    tracked, first, items = fleet.robots[robot], stops[0], fleet.items
    has_begun = tracked.held and tracked.begun_s is not None
    late_s = max(0.0, now_s - (first.done_s if has_begun else first.begin_s))
    before_s = first.begin_s
    for stop in stops:
        if stop.begin_s <= _opens_s(items[stop.item], stop) + CHECK_S:
            # It waits for its time, which takes up what is late.
            late_s = max(0.0, before_s + late_s - stop.begin_s)
        yield ExpectedStop(robot, stop, late_s)
        before_s = stop.done_s


def _opens_s(item: TrackedItem, stop: NextStop) -> float:
    """Before when it may not be begun."""
    if stop.action is Action.PICK:
        waits = item.state is ItemState.WAITING
        return item.item.pickup.window.earliest_s if waits else item.ready_s
    return item.item.delivery.window.earliest_s if stop.action is Action.DROP else 0.0
