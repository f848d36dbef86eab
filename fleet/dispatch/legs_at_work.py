"""Which robot is to do what now, and what becomes of it."""

from collections.abc import Sequence

from mend.errors import ConflictError
from mend.fleet.dispatch.booking import AnyRequest
from mend.fleet.dispatch.dispatch_state import DispatchState
from mend.fleet.dispatch.giving_up import GivingUp
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.fleet.requests import LegAction
from mend.fleet.scheduling.replanning.events import SetOut, StopBegun, StopMade
from mend.fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from mend.fleet.scheduling.replanning.live_plan import NextStop
from mend.fleet.scheduling.schedule import Action
from mend.fleet.scheduling.tolerance import CHECK_S

_CHANGED = "the plan has changed"


class LegsAtWork:
    """Hands out legs and hears of them."""

    def __init__(self, state: DispatchState, giving_up: GivingUp) -> None:
        self._state, self._giving_up = state, giving_up

    def to_begin(self) -> list[Leg]:
        """What robots are to set out for now, at most one leg each."""
        legs = (self._due_leg(robot, stops) for robot, stops in self._state.fleet.stops().items())
        return [leg for leg in legs if leg is not None]

    def to_withdraw(self) -> list[Leg]:
        """The legs under way that are not wanted any more: each is to be broken off and ended."""
        return [
            leg
            for robot, leg in self._state.under_way.items()
            if not self._state.fleet.robots[robot].held
        ]

    def why_unwanted(self, leg: Leg) -> str:
        """Why a leg that is to be withdrawn is not wanted any more."""
        item = self._state.fleet.items[leg.booking]
        if item.withdrawn or item.returns or not item.open:
            return "the request is not wanted any more"
        doers = [
            robot
            for robot, stops in self._state.fleet.stops().items()
            if robot != leg.robot and any(stop.item == leg.booking for stop in stops)
        ]
        return f"the plan has changed: {doers[0]} is to do it now" if doers else _CHANGED

    def may_begin(self, leg: Leg) -> bool:
        """Whether a robot that is at the place of its leg may do there what it is to do."""
        self._require_under_way(leg)
        if self._state.fleet.now_s < leg.not_before_s - CHECK_S:
            return False
        return leg.action is not LegAction.TAKE or self._state.fleet.is_there(leg.robot)

    def began(self, leg: Leg) -> None:
        """A robot has set out. Raises `ConflictError` where it is not to do that any more."""
        stops = self._state.fleet.stops().get(leg.robot, ())
        now = self._leg(leg.robot, stops[0]) if stops else None
        if now is None or not now.is_same(leg) or leg.robot in self._state.under_way:
            raise ConflictError(f"robot '{leg.robot}' is not to {leg.action} '{leg.booking}' now")
        self._state.apply(SetOut(leg.robot), f"{leg.robot} sets out later than planned", ())
        self._state.under_way[leg.robot] = now
        self._state.begun[leg.robot] = now.number
        self._state.settle()

    def arrived(self, leg: Leg) -> None:
        """A robot is there and begins with what it is to do. Raises `ConflictError`."""
        self._require_under_way(leg)
        self._state.apply(
            StopBegun(leg.robot),
            f"{leg.robot} has come to {leg.place} for '{leg.booking}'",
            (),
            own=leg.booking,
        )
        self._state.settle()

    def ended(self, leg: Leg, end: LegEnd) -> None:
        """What became of a leg. Raises `ConflictError` where it is none that is under way."""
        self._require_under_way(leg)
        at = leg.place if end.at is None else self._state.building.find(end.at)
        lost = (
            end.outcome is LegOutcome.ITEM_LOST and self._state.fleet.items[leg.booking].under_way
        )
        if lost:
            why = f"it was gone when {leg.robot} came to {leg.place}: {end.reason or 'lost'}"
            self._giving_up.free(
                leg, at, self._state.fleet.now_s, f"{leg.robot} does not have '{leg.booking}'"
            )
            self._giving_up.lose(self._state.bookings[leg.booking], why)
        elif end.outcome is LegOutcome.DONE and self._is_possible(leg):
            closes = leg.request.is_visit
            what = f"{leg.robot} is done with '{leg.booking}' at {leg.place}"
            self._state.apply(StopMade(leg.robot, closes), what, (), own=leg.booking)
            self._tell_done(leg, end)
        elif self._state.fleet.robots[leg.robot].held and end.outcome is not LegOutcome.DONE:
            self._giving_up.failed(leg, end, at)
        else:
            self._giving_up.free(
                leg, at, self._state.fleet.now_s, f"{leg.robot} has broken off '{leg.booking}'"
            )
        self._state.under_way.pop(leg.robot, None)
        self._state.settle()

    def _tell_done(self, leg: Leg, end: LegEnd) -> None:
        """Of what goes as it was asked again no reason is told; of what is over, what is known."""
        booking, item = self._state.bookings[leg.booking], self._state.fleet.items[leg.booking]
        kept = booking.reason if booking.fails or item.returns else None
        known = None if item.open else end.reason
        booking.attempts = 0
        booking.reason = "; ".join(each for each in (kept, known) if each) or None

    def times_s(self) -> list[float]:
        """When robots that do nothing are to set out for what they do next."""
        robots, stops = self._state.fleet.robots, self._state.fleet.stops()
        return [
            max(robots[robot].free_s, self._leaves_s(robot, left[0]))
            for robot, left in stops.items()
            if left and self._may_set_out(robot, left[0])
        ]

    def _leaves_s(self, robot: str, stop: NextStop) -> float:
        return self._state.fleet.leaves_s(robot, stop) - self._state.policy.reserve_s

    def _due_leg(self, robot: str, stops: Sequence[NextStop]) -> Leg | None:
        if not stops or not self._may_set_out(robot, stops[0]):
            return None
        free_s = self._state.fleet.robots[robot].free_s
        if max(free_s, self._leaves_s(robot, stops[0])) > self._state.fleet.now_s:
            return None
        return self._leg(robot, stops[0])

    def _may_set_out(self, robot: str, stop: NextStop) -> bool:
        """Whether it does nothing, and nobody still does something that is to be broken off with
        the item, or with what it has aboard: people may be about to take that out of its basket.
        """
        if robot in self._state.under_way:
            return False
        number = self._number(robot)
        return not any(
            not self._state.fleet.robots[other].held
            and (leg.booking == stop.item or self._state.fleet.items[leg.booking].robot == number)
            for other, leg in self._state.under_way.items()
        )

    def _number(self, robot: str) -> int:
        return list(self._state.fleet.robots).index(robot)

    def _leg(self, robot: str, stop: NextStop) -> Leg:
        request, item = self._state.bookings[stop.item].request, self._state.fleet.items[stop.item]
        not_before_s = 0.0
        if stop.action is Action.PICK:
            waits = item.state is ItemState.WAITING
            not_before_s = item.item.pickup.window.earliest_s if waits else item.ready_s
        elif stop.action is Action.DROP:
            not_before_s = item.item.delivery.window.earliest_s
        return Leg(
            robot=robot,
            number=self._state.begun.get(robot, 0) + 1,
            action=leg_action(request, item, stop.action),
            place=stop.place,
            booking=stop.item,
            request=request,
            begins_s=stop.begin_s,
            done_s=stop.done_s,
            not_before_s=not_before_s,
            waits_for=stop.partner if stop.action is Action.TAKE else None,
            held_by=None if item.held_by is None else self._state.setting.robots[item.held_by].name,
        )

    def _require_under_way(self, leg: Leg) -> None:
        now = self._state.under_way.get(leg.robot)
        if now is None or not now.is_same(leg):
            raise ConflictError(
                f"robot '{leg.robot}' is not under way to {leg.action} '{leg.booking}'"
            )

    def _is_possible(self, leg: Leg) -> bool:
        """Whether what is said to be done can have been: the item is not gone meanwhile.

        Raises `ConflictError` for what was not given yet.
        """
        item = self._state.fleet.items.get(leg.booking)
        if item is None or not (item.open or item.withdrawn):
            return False
        if leg.action is LegAction.TAKE and not self._state.fleet.may_have_loaded(leg.robot):
            raise ConflictError(f"'{leg.booking}' cannot be taken: it was not left at {leg.place}")
        return True


def leg_action(request: AnyRequest, item: TrackedItem, action: Action) -> LegAction:
    """What a stop of the plan is for the request of its item."""
    match action:
        case Action.GIVE:
            return LegAction.GIVE
        case Action.TAKE:
            return LegAction.TAKE
        case Action.PICK:
            lies = item.state is ItemState.LEFT and request.comes_back
            return LegAction.TAKE if lies else request.fetching
        case Action.DROP:
            return LegAction.BRING_BACK if item.returns else request.bringing
