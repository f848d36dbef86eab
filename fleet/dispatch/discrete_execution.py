"""Legs carried out in drawn times instead of by robots: weeks of a building in seconds.

Discrete events only: from one to the next nothing is computed. The same seed gives the same events.
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
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.fleet.requests import LegAction

Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Mean = Annotated[float, Field(ge=0.0, le=86400.0, allow_inf_nan=False)]

SHORTEST_S = 1.0
"""Whoever waits looks again after that at the earliest."""


class LegTimes(StrictModel):
    """What a leg takes, and how it ends; times are drawn from exponential distributions.

    Driving takes what is planned times a lognormal factor of median 1 (`drive_spread`: the standard
    deviation of its logarithm). At a share `start_share` of the beginnings a robot waits for help,
    `start_mean_s` in the mean; before each change of floors for the elevator; on a share
    `blocked_share` of the drives because something is in its way; at the place until somebody
    comes. A leg fails at its end for a share `fails`; what was to be given or taken is lost for a
    share `loses`.
    """

    drive_spread: Annotated[float, Field(ge=0.0, le=2.0, allow_inf_nan=False)] = 0.1
    start_share: Share = 0.1
    start_mean_s: Mean = 60.0
    elevator_mean_s: Mean = 45.0
    blocked_share: Share = 0.1
    blocked_mean_s: Mean = 30.0
    end_mean_s: Mean = 20.0
    fails: Share = 0.05
    loses: Share = 0.002


@dataclass(frozen=True, slots=True)
class LegRecord:
    """Where the time of a leg went (seconds); `waiting_s`: for its window or another robot."""

    leg: Leg
    begun_s: float
    start_s: float
    elevator_s: float
    driving_s: float
    blocked_s: float
    waiting_s: float = 0.0
    end_s: float = 0.0
    outcome: LegOutcome | None = None


class DrawnExecution:
    """Carries out what a dispatcher hands out; `records` has the legs that ended.

    `watch` is called after everything that happened, and may look at the dispatcher or replace it
    (`dispatcher`). The time begins with the dispatcher's.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        times: LegTimes,
        chance: Random,
        *,
        watch: Callable[[str], None] = lambda _: None,
    ) -> None:
        self.dispatcher = dispatcher
        self.now_s = dispatcher.now_s
        self.records: list[LegRecord] = []
        self._times, self._chance, self._watch = times, chance, watch
        self._events: list[tuple[float, int, Callable[[], str]]] = []
        self._numbers = count()
        self._open: dict[str, LegRecord] = {}
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
            self._end(record, leg, LegEnd(outcome=LegOutcome.WITHDRAWN, reason="not wanted"))
        for robot in list(self._waiting):
            if robot in self._open:
                self._arrive(self._open[robot].leg)
        # Each that begins may change what the others are to do.
        while legs := self.dispatcher.legs_to_begin(self.now_s):
            self._begin(legs[0])

    def _begin(self, leg: Leg) -> None:
        dispatcher, times = self.dispatcher, self._times
        dispatcher.began(leg, self.now_s)
        robot = dispatcher.fleet.robots[leg.robot]
        assert robot.trip is not None, "it has set out"
        planned_s = robot.free_s - robot.trip.leaves_s
        floors = [place.floor for place in dispatcher.building.graph.places]
        rides = floors[robot.trip.origin] != floors[robot.place]
        record = LegRecord(
            leg,
            self.now_s,
            self._wait_s(times.start_share, times.start_mean_s),
            self._wait_s(1.0 if rides else 0.0, times.elevator_mean_s),
            planned_s * self._chance.lognormvariate(0.0, times.drive_spread),
            self._wait_s(times.blocked_share, times.blocked_mean_s),
        )
        self._open[leg.robot] = record
        lasts_s = record.start_s + record.elevator_s + record.driving_s + record.blocked_s
        self.call_at(self.now_s + lasts_s, lambda: self._arrive(leg))
        self._watch(f"{leg.robot} sets out to {leg.action} '{leg.booking}'")

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
