"""What cannot be done: tried again, brought back, or given up with a reason."""

from mend.fleet.dispatch.booking import Booking
from mend.fleet.dispatch.dispatch_state import DispatchState
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.fleet.scheduling.replanning.events import (
    Cancelled,
    Fetched,
    ItemLost,
    StopFailed,
    Stranded,
)
from mend.fleet.scheduling.replanning.item_state import ItemState


class GivingUp:
    """Ends what fails, so that nothing waits for ever and everything is accounted for."""

    def __init__(self, state: DispatchState) -> None:
        self._state = state

    def free(self, leg: Leg, at: str, again_s: float | None, why: str) -> None:
        """A robot has not done what it set out for; it may be tried again from a time on."""
        self._state.apply(StopFailed(leg.robot, at, again_s), why, set(), own=leg.booking)

    def failed(self, leg: Leg, end: LegEnd, at: str) -> None:
        """A leg that is still wanted was not done: try again later, or give up."""
        booking, item = self._state.bookings[leg.booking], self._state.fleet.items[leg.booking]
        what = f"{leg.robot} could not {leg.action.words} '{leg.booking}' at {leg.place}"
        said = f"{what}: {end.reason or end.outcome}"
        booking.reason, waits = said, item.state is ItemState.WAITING
        now_s = self._state.fleet.now_s
        withdrawn = end.outcome is LegOutcome.WITHDRAWN
        booking.attempts += not withdrawn
        again_s = now_s if withdrawn else now_s + self._state.policy.retry_after_s
        goes_on = end.outcome is not LegOutcome.ITEM_LOST
        if waits and again_s > item.item.pickup.window.latest_s:
            booking.reason = f"{said}; there is no time to try it again"
        elif goes_on and booking.attempts < self._state.policy.max_attempts:
            self.free(leg, at, again_s, f"{said}; it is tried again at {again_s:g} s")
            return
        booking.fails = True
        self.free(leg, at, None if waits else now_s, said)
        if not waits:
            self.give_up(booking, said)

    def lose(self, booking: Booking, reason: str) -> None:
        """What was on its way is gone."""
        self._state.apply(
            ItemLost(booking.name), f"'{booking.name}' is lost: {reason}", {booking.name}
        )
        booking.reason = f"it is lost: {reason}"

    def give_up(self, booking: Booking, why: str) -> None:
        """Nothing more is tried; what was fetched goes back, or stays where it is for a person."""
        item, name = self._state.fleet.items[booking.name], booking.name
        if not item.under_way or (booking.request.comes_back and not item.returns):
            self._state.apply(Cancelled(name), why, {name})
            booking.attempts = 0
            return
        self._strand(booking, why)

    def _strand(self, booking: Booking, why: str) -> None:
        """No robot does any more: a thing stays where it is, a person is on their own."""
        where, name = self._state.where(self._state.fleet.items[booking.name]), booking.name
        if booking.request.comes_back:
            self._state.apply(Stranded(name), why, {name})
            why = booking.reason or why
            booking.reason = f"{why}; it was last {where}, for a person to take it"
        else:
            self._state.apply(Fetched(name), why, {name})

    def end_patience(self, booking: Booking) -> None:
        """End what has had no place for too long."""
        since_s, now_s = booking.put_off_since_s, self._state.fleet.now_s
        # What a robot does with it just now still counts.
        if since_s is None or any(
            leg.booking == booking.name for leg in self._state.under_way.values()
        ):
            return
        item = self._state.fleet.items[booking.name]
        over = not item.under_way and item.item.pickup.window.latest_s < now_s
        if not over and now_s - since_s < self._state.policy.patience_s:
            return
        booking.fails = True
        if item.under_way:
            booking.reason = item.put_off
            self._strand(booking, f"nobody can bring '{booking.name}'")
        else:
            self.give_up(booking, f"nobody had a place for '{booking.name}' in time")
        self._state.settle()
