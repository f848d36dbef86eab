"""Hands the requests of one building's people to its robots, leg by leg, and follows what comes.

Whoever carries out the legs says what became of each; times are passed in, seconds on one clock
that never goes back. What is raised is a `RefusalError` and leaves all but the time as it was.
"""

from collections.abc import Iterable, Mapping, Sequence
from math import ceil, inf
from typing import Self

from mend.errors import NotFoundError, WrongInputError
from mend.fleet.dispatch.booking import Answer, AnyRequest, Expected, PlanChange, RequestView
from mend.fleet.dispatch.booking_desk import BookingDesk
from mend.fleet.dispatch.dispatch_state import DispatchState
from mend.fleet.dispatch.giving_up import GivingUp
from mend.fleet.dispatch.leg import Finding, Found, Leg, LegEnd
from mend.fleet.dispatch.legs_at_work import LegsAtWork, leg_action
from mend.fleet.dispatch.recurring import Recurring
from mend.fleet.dispatch.setting import FleetSetting
from mend.fleet.dispatch.snapshot import DispatcherSnapshot, restore, snapshot_of
from mend.fleet.dispatch.taking_over import TakingOver
from mend.fleet.dispatch.views import stops_by_booking, view_of
from mend.fleet.requests import LegAction
from mend.fleet.scheduling.replanning.events import (
    DoorClosed,
    Fetched,
    RobotBack,
    RobotFailed,
    RobotMoved,
    TimePassed,
    WayOpen,
)
from mend.fleet.scheduling.replanning.item_state import ItemState
from mend.fleet.scheduling.replanning.live_plan import NextStop
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.tolerance import CHECK_S
from mend.maps.building.building import Building

REOPENS_EVERY_S = 300.0
"""What is closed for a while counts as open at multiples of this: plans know few such times."""
_FOUND = {
    Finding.BLOCKED: "the way blocked",
    Finding.DOOR_CLOSED: "a closed door",
    Finding.ELEVATOR_DEAD: "a dead elevator",
}
CLOSED_ITEMS = 64
"""So many items with which nothing remains to be done are forgotten at once."""


class Dispatcher:
    """The requests of a building's people and its robots.

    Raises `WrongInputError` or `NotFoundError` for a setting that does not fit the building.
    """

    def __init__(self, building: Building, setting: FleetSetting, *, now_s: float = 0.0) -> None:
        self._state = DispatchState(building, setting)
        self._giving_up = GivingUp(self._state)
        self._recurring = Recurring(self._state)
        self._desk = BookingDesk(self._state, self._giving_up, self._recurring)
        self._legs = LegsAtWork(self._state, self._giving_up)
        self._taking_over = TakingOver(self._state)
        self._state.fleet.advance(now_s)

    @classmethod
    def restored(
        cls, building: Building, setting: FleetSetting, snapshot: DispatcherSnapshot
    ) -> Self:
        """A dispatcher equal to the one whose snapshot it was.

        Raises `UnreadableError` where the building or its robots are others now.
        """
        dispatcher = cls(building, setting)
        restore(dispatcher._state, snapshot)
        return dispatcher

    def snapshot(self) -> DispatcherSnapshot:
        """All that is known, to be kept; `restored` makes an equal dispatcher of it."""
        return snapshot_of(self._state)

    # --- what people ask --------------------------------------------------------------------------

    def submit(self, request: AnyRequest, now_s: float) -> Answer:
        """Book a request, or refuse it with the next time at which it could be met.

        Of one that recurs the first occurrence decides. Raises `ConflictError` where there is one
        of that name, `NotFoundError` for a place that the building does not have.
        """
        self._desk.require_free(request.name)
        for place in request.places:
            self.building.find(place)
        self._advance(now_s)
        return self._desk.submit(request)

    def cancel(self, name: str, now_s: float) -> RequestView | None:
        """What is asked for under a name is not wanted any more; what is fetched goes back.

        Of a request that recurs all that is still open goes; then there is no view. Raises
        `NotFoundError`, and `ConflictError` where it is over.
        """
        self._advance(now_s)
        self._desk.cancel(name)
        return self.view(name) if name in self._state.bookings else None

    def change(self, name: str, request: AnyRequest, now_s: float) -> Answer:
        """Book other words for what nobody has set out for yet; refused, it stays as it was.

        Raises `NotFoundError`, and `ConflictError` where it is too late or it recurs.
        """
        self._advance(now_s)
        return self._desk.change(name, request)

    # --- what robots do ---------------------------------------------------------------------------

    def legs_to_begin(self, now_s: float) -> list[Leg]:
        """What robots are to set out for now, at most one leg each."""
        self._advance(now_s)
        return self._legs.to_begin()

    def legs_to_withdraw(self, now_s: float) -> list[Leg]:
        """The legs under way that are not wanted any more: each is to be broken off and ended."""
        self._advance(now_s)
        return self._legs.to_withdraw()

    def why_unwanted(self, leg: Leg) -> str:
        """Why one of `legs_to_withdraw` is not wanted any more."""
        return self._legs.why_unwanted(leg)

    def legs_under_way(self) -> list[Leg]:
        """The legs that were begun and have not ended."""
        return list(self._state.under_way.values())

    def may_begin(self, leg: Leg, now_s: float) -> bool:
        """Whether a robot that is at the place of its leg may do there what it is to do.

        Raises `ConflictError` where the leg is none that is under way.
        """
        self._advance(now_s)
        return self._legs.may_begin(leg)

    def began(self, leg: Leg, now_s: float) -> None:
        """A robot has set out. Raises `ConflictError` where it is not to do that any more."""
        self._advance(now_s)
        self._legs.began(leg)

    def arrived(self, leg: Leg, now_s: float) -> None:
        """A robot is there and begins with what it is to do. Raises `ConflictError`."""
        self._advance(now_s)
        self._legs.arrived(leg)

    def ended(self, leg: Leg, end: LegEnd, now_s: float) -> None:
        """What became of a leg. Raises `ConflictError` where it is none that is under way."""
        self._advance(now_s)
        self._legs.ended(leg, end)

    def item_lost(self, name: str, reason: str, now_s: float) -> None:
        """What was on its way for a request is gone. Raises `ConflictError` where it was not."""
        self._advance(now_s)
        self._giving_up.lose(self._state.open_booking(name), reason)
        self._state.settle()

    def fetched(self, name: str, now_s: float) -> None:
        """A person took what a robot had for a request, or what lay somewhere.

        Raises `ConflictError` where there is no such thing, `NotFoundError`.
        """
        self._advance(now_s)
        booking = self._state.bookings.get(name)
        if booking is None:
            raise NotFoundError(f"there is no request '{name}'")
        why = f"a person took what was to be brought for '{name}'"
        self._state.apply(Fetched(name), why, {name})
        if booking.open:
            booking.reason = why
        self._state.settle()

    # --- what happens to robots and ways ----------------------------------------------------------

    def robot_failed(
        self, robot: str, at: str | None, reason: str, now_s: float, *, lost: Iterable[str] = ()
    ) -> None:
        """A robot works no more and stands at a place (None: where it should be by now); others
        fetch what it has, but what is `lost` with it. Its leg has ended with that.

        Raises `ConflictError` where it works no more already, `NotFoundError` for the place.
        """
        self._advance(now_s)
        where, missing = None if at is None else self.building.find(at), frozenset(lost)
        event = RobotFailed(robot, missing, where)
        self._state.apply(event, f"{robot} has failed: {reason}", missing)
        for name in missing:
            self._state.bookings[name].reason = f"it was lost with {robot}: {reason}"
        self._state.under_way.pop(robot, None)
        self._state.settle()

    def robot_back(self, robot: str, at: str, now_s: float) -> None:
        """A robot works again, at a place. Raises `ConflictError`, `NotFoundError`."""
        self._advance(now_s)
        self._state.apply(RobotBack(robot, self.building.find(at)), f"{robot} works again", ())
        self._state.settle()

    def robot_moved(self, robot: str, at: str, now_s: float) -> None:
        """A robot that had nothing to do, or works no more, stands at another place now.

        Raises `ConflictError` where it has something to do, `NotFoundError`.
        """
        self._advance(now_s)
        event = RobotMoved(robot, self.building.find(at))
        self._state.apply(event, f"{robot} stands at {at} now", ())
        self._state.settle()

    def found(self, found: Found, now_s: float) -> None:
        """A robot has found a way blocked, a door closed, or an elevator dead, which counts for a
        while; or open.

        Raises `ConflictError` where the places are no neighbours, or more changes than plans can
        know; `NotFoundError`.
        """
        self._advance(now_s)
        a, b = (self.building.find(each) for each in found.between)
        by = "somebody" if found.by is None else found.by
        if found.finding is Finding.OPEN:
            self._state.apply(WayOpen((a, b)), f"{by} found the way between {a} and {b} open", ())
        else:
            until_s = self.now_s + self._state.policy.forget_s
            closing = self._closing(a, b, until_s if found.until_s is None else found.until_s)
            until_s = self.now_s + closing.retry_s
            what = _FOUND[found.finding]
            why = f"{by} found {what} between {a} and {b}, which counts until {until_s:g} s"
            self._state.apply(closing, why, ())
        self._state.settle()

    def take_over(self, found: Found, now_s: float) -> str | None:
        """Have another robot do the leg of one whose way is barred, if one can do that without
        anything being late and without more help of people; who that is.

        The way then counts as closed until it would be tried again. Raises `NotFoundError`.
        """
        self._advance(now_s)
        a, b = (self.building.find(each) for each in found.between)
        closing = self._closing(a, b, self.now_s + self._state.policy.retry_after_s)
        return self._taking_over.by_another(found, closing)

    def _closing(self, a: str, b: str, until_s: float) -> DoorClosed:
        until_s = REOPENS_EVERY_S * ceil(max(until_s, self.now_s + 1.0) / REOPENS_EVERY_S)
        return DoorClosed((a, b), until_s - self.now_s)

    # --- what is known ----------------------------------------------------------------------------

    @property
    def building(self) -> Building:
        """The building."""
        return self._state.building

    @property
    def setting(self) -> FleetSetting:
        """The robots, and what holds for them."""
        return self._state.setting

    @property
    def now_s(self) -> float:
        """The latest time that was told."""
        return self._state.fleet.now_s

    @property
    def fleet(self) -> RunningFleet:
        """The plan, the robots and the items, to be read only."""
        return self._state.fleet

    @property
    def log(self) -> Sequence[PlanChange]:
        """Why the plan became another one, the latest last."""
        return self._state.log.changes

    def closed_until_s(self) -> Mapping[frozenset[str], float]:
        """The ways that were found blocked or closed, and until when that counts."""
        return self._state.fleet.closed_until_s()

    def taken_out(self) -> Mapping[str, frozenset[str]]:
        """By robot, the requests whose things were taken out of its basket for others, of which it
        has to be told before it sets out."""
        return self._state.fleet.taken_out()

    def views(self, now_s: float | None = None) -> list[RequestView]:
        """All requests that are known, in the order in which they came, for who reads them then.

        None: at the latest time that was told.
        """
        stops = stops_by_booking(self._state.fleet, now_s)
        return [view_of(booking, stops) for booking in self._state.bookings.values()]

    def count_open(self) -> int:
        """How many requests have not ended: each occurrence that is planned, and each series."""
        open_ = sum(booking.open for booking in self._state.bookings.values())
        return open_ + sum(not series.over for series in self._state.series.values())

    def view(self, name: str, now_s: float | None = None) -> RequestView:
        """How far a request has come, for who reads that then. Raises `NotFoundError`."""
        if name in self._state.series:
            raise NotFoundError(f"the request '{name}' recurs: look at '{name}/1' and so on")
        if name not in self._state.bookings:
            raise NotFoundError(f"there is no request '{name}'")
        return view_of(self._state.bookings[name], stops_by_booking(self._state.fleet, now_s))

    def expected(self, name: str) -> Expected | None:
        """When it is begun and done; None where it is in no plan. Raises `NotFoundError`."""
        return self.view(name).expected

    def stops(self) -> Mapping[str, Sequence[tuple[NextStop, LegAction]]]:
        """What each robot is still to do, by its name, and what that is for its request."""
        bookings, items = self._state.bookings, self._state.fleet.items
        return {
            robot: [
                (each, leg_action(bookings[each.item].request, items[each.item], each.action))
                for each in stops
            ]
            for robot, stops in self._state.fleet.stops().items()
        }

    def wakes_s(self) -> float | None:
        """When `legs_to_begin` has to be asked again, if nothing happens before."""
        policy = self._state.policy
        times = [*self._legs.times_s(), *self.closed_until_s().values()]
        times += self._recurring.times_s()
        if self._waits():
            times.append(self._state.tried_s + policy.retry_waiting_s)
        return max(self.now_s, min(times)) if times else None

    # --- time goes by -----------------------------------------------------------------------------

    def _advance(self, now_s: float) -> None:
        """Let time pass; what waits is tried again, and given up where its time is over."""
        state = self._state
        if not self.now_s - CHECK_S <= now_s < inf:
            raise WrongInputError(f"it is {self.now_s:g} s already, not {now_s:g} s")
        with state.log.entry(lambda: state.fleet, "what was planned is late", ()) as outcomes:
            outcomes.append(state.fleet.advance(now_s))
        if self._waits() and self.now_s >= state.tried_s + state.policy.retry_waiting_s:
            state.tried_s = self.now_s
            state.apply(TimePassed(), "what had no place is tried again", ())
        state.settle()
        for booking in [each for each in state.bookings.values() if each.open]:
            self._giving_up.end_patience(booking)
        self._desk.book_recurring()
        self._forget()

    def _waits(self) -> bool:
        return any(each.put_off_since_s is not None for each in self._state.bookings.values())

    def _forget(self) -> None:
        """Forget what has been over for long, but for what a person still has to take."""
        state = self._state
        if sum(not each.open for each in state.fleet.items.values()) >= CLOSED_ITEMS:
            state.fleet.forget_closed()
        closed = [name for name, each in state.bookings.items() if not each.open]
        if len(closed) > state.policy.kept:
            items = state.fleet.items
            stranded = {n for n, item in items.items() if item.state is ItemState.STRANDED}
            for name in closed[: len(closed) - state.policy.kept]:
                if name not in stranded:
                    del state.bookings[name]
        for name in [name for name, each in state.series.items() if each.over]:
            if not state.occurrences(name):
                del state.series[name]
