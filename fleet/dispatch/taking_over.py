"""A robot whose way is barred: another one does its leg, if it can, before people are asked."""

from collections.abc import Sequence
from itertools import pairwise

from mend.fleet.dispatch.dispatch_state import DispatchState
from mend.fleet.dispatch.leg import Found, Leg
from mend.fleet.scheduling.replanning.events import DoorClosed, EventError, LetGo
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.maps.building.building import Caller


class TakingOver:
    """Finds out who could do a leg, and has them do it."""

    def __init__(self, state: DispatchState) -> None:
        self._state = state

    def by_another(self, found: Found, closing: DoorClosed) -> str | None:
        """Who does the leg of whoever has found its way barred; None where people are to help.

        Nothing may have to wait or be late for that, and no more of people may be asked: nobody
        takes over who has to have elevators called for it. What a robot has aboard stays its own.
        """
        leg = self._state.under_way.get(found.by or "")
        if leg is None or self._state.fleet.items[leg.booking].robot is not None:
            return None
        now_s, stands_at = self._state.fleet.now_s, closing.between[0]
        trial = self._state.fleet.fork()
        try:
            events = (closing, LetGo(leg.robot, stands_at))
            outcomes = [trial.apply(event, now_s) for event in events]
        except EventError:
            return None
        other = next((r for r in trial.robots if r != leg.robot and _does(trial, r, leg)), None)
        worse = any(each.put_off or each.late or each.overtime for each in outcomes)
        if other is None or worse or self._calls(trial) > self._calls(self._state.fleet):
            return None
        self._hand_over(leg, closing, other)
        return other

    def _hand_over(self, leg: Leg, closing: DoorClosed, other: str) -> None:
        state, (a, b) = self._state, closing.between
        until_s = state.fleet.now_s + closing.retry_s
        why = f"{leg.robot} found no way between {a} and {b}, which counts until {until_s:g} s"
        state.apply(closing, why, ())
        barred = f"which found no way between {a} and {b}"
        why = f"{other} takes over '{leg.booking}' from {leg.robot}, {barred}"
        state.apply(LetGo(leg.robot, a), why, {leg.booking})
        state.settle()

    def _calls(self, fleet: RunningFleet) -> int:
        """How often people are to call an elevator for robots."""
        return sum(self._called_for(fleet.passes(robot)) for robot in fleet.robots)

    def _called_for(self, places: Sequence[str]) -> int:
        called = [
            {f"{floor}/{at}" for floor, at in each.stops.items()}
            for each in self._state.building.document.elevators.values()
            if each.called_by is Caller.PEOPLE
        ]
        rides = [{a, b} for a, b in pairwise(places) if a != b]
        return sum(any(ride <= stops for stops in called) for ride in rides)


def _does(fleet: RunningFleet, robot: str, leg: Leg) -> bool:
    return any(stop.item == leg.booking for stop in fleet.stops()[robot])
