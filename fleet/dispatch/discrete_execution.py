"""Legs carried out in discrete events instead of by robots: weeks of a building in seconds.

From one event to the next nothing is computed. How long drives take is computed once for each pair
of places (`TripTimes`), elevators take one robot at a time, and what people do takes drawn times.
The same seed gives the same events.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from heapq import heappop, heappush
from itertools import count
from math import inf
from random import Random
from typing import Annotated

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.fleet.dispatch.cabins import Cabins
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.fleet.dispatch.trip_times import TripTimes
from mend.fleet.requests import LegAction
from mend.maps.building.building import Caller
from mend.maps.building.trip import Trip, TripRide

Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Mean = Annotated[float, Field(ge=0.0, le=86400.0, allow_inf_nan=False)]

SHORTEST_S = 1.0
"""Whoever waits looks again after that at the earliest."""


class LegTimes(StrictModel):
    """How long people take, and how a leg ends; times are drawn from exponential distributions.

    At a share `start_share` of the beginnings a robot waits for help, `start_mean_s` in the mean;
    before each elevator that people call until somebody presses its button; at a share `door_share`
    of the doors that people open until somebody does; on a share `blocked_share` of the drives
    because something is in its way; at the place until somebody comes. A drive is `detour_mean_s`
    longer, as it leads round people and furniture. A leg fails at its end for a share `fails`; what
    was to be given or taken is lost for a share `loses`.
    """

    start_share: Share = 0.1
    start_mean_s: Mean = 60.0
    elevator_mean_s: Mean = 45.0
    door_share: Share = 0.2
    door_mean_s: Mean = 30.0
    blocked_share: Share = 0.1
    blocked_mean_s: Mean = 30.0
    detour_mean_s: Mean = 0.8
    """As `benchmarks/drive_times.py --first 2001 --people 10 --unmapped 0.2` measured it."""
    end_mean_s: Mean = 20.0
    fails: Share = 0.05
    loses: Share = 0.002


@dataclass(frozen=True, slots=True)
class LegRecord:
    """Where the time of a leg went (seconds).

    `elevator_s`: waiting for elevators and riding them; `blocked_s`: before doors, and by what is
    in the way; `waiting_s`: for its window or another robot. It has driven `driven_m` metres.
    """

    leg: Leg
    begun_s: float
    start_s: float = 0.0
    elevator_s: float = 0.0
    driving_s: float = 0.0
    blocked_s: float = 0.0
    waiting_s: float = 0.0
    end_s: float = 0.0
    driven_m: float = 0.0
    outcome: LegOutcome | None = None


@dataclass(frozen=True, slots=True)
class _Drive:
    """A robot drives from place to place of a floor, or stands where both are the same."""

    origin: str
    destination: str
    since_s: float
    lasts_s: float


class DiscreteExecution:
    """Carries out what a dispatcher hands out; `records` has the legs that ended.

    `trips` knows how long drives take. `watch` is called after everything that happened, and may
    look at the dispatcher or replace it (`dispatcher`). The time begins with the dispatcher's.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        trips: TripTimes,
        times: LegTimes,
        chance: Random,
        *,
        watch: Callable[[str], None] = lambda _: None,
    ) -> None:
        self.dispatcher = dispatcher
        self.now_s = dispatcher.now_s
        self.records: list[LegRecord] = []
        self._trips, self._times, self._chance, self._watch = trips, times, chance, watch
        self._cabins = Cabins(dispatcher.building)
        self._events: list[tuple[float, int, Callable[[], str]]] = []
        self._numbers = count()
        self._open: dict[str, LegRecord] = {}
        self._drives: dict[str, _Drive] = {}
        self._waiting: dict[str, float] = {}

    def call_at(self, time_s: float, call: Callable[[], str]) -> None:
        """Something else happens at a time; it says what, for `watch`."""
        heappush(self._events, (max(time_s, self.now_s), next(self._numbers), call))

    def run_until(self, until_s: float) -> None:
        """Let everything happen until a time."""
        self._hand_out()
        while (next_s := self._next_s()) <= until_s:
            self.now_s = next_s
            if self._events and self._events[0][0] <= next_s:
                _, _, call = heappop(self._events)
                self._watch(call())
            self._hand_out()
        self.now_s = max(self.now_s, until_s)

    def _next_s(self) -> float:
        wakes_s = self.dispatcher.wakes_s()
        later_s = inf if wakes_s is None else max(wakes_s, self.now_s + SHORTEST_S)
        times = [later_s, *(max(each, self.now_s) for each in self._waiting.values())]
        return min([*times, self._events[0][0]]) if self._events else min(times)

    # --- what robots do ---------------------------------------------------------------------------

    def _hand_out(self) -> None:
        """Break off what is not wanted any more, begin what can begin."""
        for leg in self.dispatcher.legs_to_withdraw(self.now_s):
            record = self._open.pop(leg.robot, None)
            at = self._last_passed(leg.robot)
            why = self.dispatcher.why_unwanted(leg)
            end = LegEnd(outcome=LegOutcome.WITHDRAWN, reason=why, at=at)
            self._end(record, leg, end)
        for robot in list(self._waiting):
            if robot in self._open:
                self._arrive(self._open[robot].leg)
        # Each that begins may change what the others are to do.
        while legs := self.dispatcher.legs_to_begin(self.now_s):
            self._begin(legs[0])

    def _begin(self, leg: Leg) -> None:
        dispatcher, times = self.dispatcher, self._times
        dispatcher.began(leg, self.now_s)
        robot, places = dispatcher.fleet.robots[leg.robot], dispatcher.building.graph.places
        assert robot.trip is not None, "it has set out"
        origin = places[robot.trip.origin].name
        trip = self._trips.trip(origin, places[robot.place].name)
        self._drives[leg.robot] = _Drive(origin, origin, self.now_s, 0.0)
        record = LegRecord(leg, self.now_s, self._wait_s(times.start_share, times.start_mean_s))
        self._open[leg.robot] = record
        self.call_at(self.now_s + record.start_s, lambda: self._drive(leg, trip, origin))
        self._watch(f"{leg.robot} sets out to {leg.action} '{leg.booking}'")

    def _drive(self, leg: Leg, trip: Trip, origin: str) -> str:
        """The next stage of a trip, from a place of its floor."""
        if not self._goes_on(leg):
            return "a leg that is over"
        stage, times, record = trip[0], self._times, self._open[leg.robot]
        driving_s = stage.drives_s / self.dispatcher.fleet.robots[leg.robot].robot.speed
        driving_s += self._wait_s(1.0, times.detour_mean_s)
        blocked_s = self._wait_s(times.blocked_share, times.blocked_mean_s)
        for _ in range(stage.doors):
            blocked_s += self._wait_s(times.door_share, times.door_mean_s)
        self._open[leg.robot] = replace(
            record,
            driving_s=record.driving_s + driving_s,
            blocked_s=record.blocked_s + blocked_s,
            driven_m=record.driven_m + stage.drives_m,
        )
        lasts_s, there_s = driving_s + blocked_s, self.now_s + driving_s + blocked_s
        if stage.ride is None:
            self._drives[leg.robot] = _Drive(origin, leg.place, self.now_s, lasts_s)
            self.call_at(there_s, lambda: self._arrive(leg))
            return f"{leg.robot} drives to {leg.place}"
        ride, plan = stage.ride, self.dispatcher.building.document.elevators[stage.ride.elevator]
        stop = f"{ride.from_floor}/{plan.stops[ride.from_floor]}"
        self._drives[leg.robot] = _Drive(origin, stop, self.now_s, lasts_s)
        pressed_s = 0.0
        if plan.called_by is Caller.PEOPLE:
            pressed_s = self._wait_s(1.0, times.elevator_mean_s)
        self.call_at(there_s + pressed_s, lambda: self._ride(leg, ride, trip[1:], pressed_s))
        return f"{leg.robot} drives to {ride.elevator}"

    def _ride(self, leg: Leg, ride: TripRide, rest: Trip, pressed_s: float) -> str:
        if not self._goes_on(leg):
            return "a leg that is over"
        lasts, record = self._cabins.take(ride, self.now_s), self._open[leg.robot]
        lasts_s = lasts.waits_s + lasts.rides_s
        stops = self.dispatcher.building.document.elevators[ride.elevator].stops
        stop = f"{ride.to_floor}/{stops[ride.to_floor]}"
        self._drives[leg.robot] = _Drive(stop, stop, self.now_s, 0.0)
        elevator_s = record.elevator_s + pressed_s + lasts_s
        self._open[leg.robot] = replace(record, elevator_s=elevator_s)
        self.call_at(self.now_s + lasts_s, lambda: self._drive(leg, rest, stop))
        return f"{leg.robot} has called {ride.elevator}"

    def _arrive(self, leg: Leg) -> str:
        if not self._goes_on(leg):
            return "a leg that is over"
        if not self.dispatcher.may_begin(leg, self.now_s):
            # What another robot has to do first comes with its events.
            later_s = leg.not_before_s if leg.not_before_s > self.now_s else inf
            self._waiting[leg.robot] = later_s
            return f"{leg.robot} waits at {leg.place}"
        self._waiting.pop(leg.robot, None)
        self.dispatcher.arrived(leg, self.now_s)
        record = self._open[leg.robot]
        arrived_s = record.begun_s + record.start_s + record.elevator_s
        arrived_s += record.driving_s + record.blocked_s
        needs_person = leg.action not in (LegAction.GIVE, LegAction.TAKE, LegAction.VISIT)
        end_s = self._wait_s(1.0 if needs_person else 0.0, self._times.end_mean_s)
        self._open[leg.robot] = replace(record, waiting_s=self.now_s - arrived_s, end_s=end_s)
        lasts_s = end_s + max(0.0, leg.done_s - leg.begins_s)
        self.call_at(self.now_s + lasts_s, lambda: self._finish(leg))
        return f"{leg.robot} is at {leg.place}"

    def _finish(self, leg: Leg) -> str:
        if not self._goes_on(leg):
            return "a leg that is over"
        draw, end = self._chance.random(), LegEnd(outcome=LegOutcome.DONE)
        if draw < self._times.loses and leg.action is not LegAction.VISIT:
            end = LegEnd(outcome=LegOutcome.ITEM_LOST, reason="it is not there")
        elif draw < self._times.loses + self._times.fails:
            end = LegEnd(outcome=LegOutcome.FAILED, reason="nobody came")
        self._end(self._open.pop(leg.robot), leg, end)
        return f"{leg.robot} has ended to {leg.action} '{leg.booking}': {end.outcome}"

    def _end(self, record: LegRecord | None, leg: Leg, end: LegEnd) -> None:
        self._waiting.pop(leg.robot, None)
        self.dispatcher.ended(leg, end, self.now_s)
        if record is not None:
            self.records.append(replace(record, outcome=end.outcome))

    def _last_passed(self, robot: str) -> str | None:
        """The place at which a robot that breaks off its drive turns round; None: where it leads.

        Who has called an elevator rides first.
        """
        drive, graph = self._drives.get(robot), self.dispatcher.building.graph
        if drive is None or self.now_s >= drive.since_s + drive.lasts_s:
            return None if drive is None else drive.destination
        ends = graph.index(drive.origin), graph.index(drive.destination)
        path = graph.quickest_path(*ends, self.dispatcher.setting.speed_m_s)
        share = (self.now_s - drive.since_s) / drive.lasts_s
        passed = [place for place, after_s in path if after_s <= share * path[-1][1]]
        return graph.places[passed[-1]].name if passed else drive.destination

    def _goes_on(self, leg: Leg) -> bool:
        """Whether the leg is under way still: its robot may have failed meanwhile."""
        goes_on = any(leg.is_same(each) for each in self.dispatcher.legs_under_way())
        if not goes_on and leg.robot in self._open and self._open[leg.robot].leg.is_same(leg):
            del self._open[leg.robot]
            self._waiting.pop(leg.robot, None)
        return goes_on

    def _wait_s(self, share: float, mean_s: float) -> float:
        if mean_s == 0.0 or self._chance.random() >= share:
            return 0.0
        return self._chance.expovariate(1.0 / mean_s)
