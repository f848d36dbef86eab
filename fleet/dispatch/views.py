"""How far requests have come and when they are expected, for whoever asked."""

from collections.abc import Mapping, Sequence

from mend.fleet.dispatch.booking import Booking, Expected, RequestView
from mend.fleet.scheduling.replanning.live_plan import NextStop
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet

Stops = Mapping[str, Sequence[tuple[str, NextStop]]]
"""By booking, who is to do what for it."""


def stops_by_booking(fleet: RunningFleet) -> Stops:
    """What is still to be done for each booking, by whom."""
    found: dict[str, list[tuple[str, NextStop]]] = {}
    for robot, stops in fleet.stops().items():
        for stop in stops:
            found.setdefault(stop.item, []).append((robot, stop))
    return found


def view_of(booking: Booking, stops: Stops) -> RequestView:
    """One request as it is now."""
    mine = sorted(stops.get(booking.name, ()), key=lambda each: each[1].begin_s)
    expected = None
    if mine and booking.open:
        robot, first = mine[0]
        done_s = mine[0 if booking.request.is_visit else -1][1].done_s
        expected = Expected(robot, first.place, first.begin_s, done_s)
    return RequestView(booking.name, booking.request, booking.status, booking.reason, expected)
