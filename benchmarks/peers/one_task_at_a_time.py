"""The plain ways of sharing out what is asked for: each robot does one request at a time.

First come, first served: whenever a robot is free, the request that has waited longest goes to
the free robot that is nearest to where it begins. Lowest bid, as Open-RMF's dispatcher awards its
tasks: each request is put up as soon as it is made, every robot says when it would have done it,
after what it was given before and in that order, and the earliest has it.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import partial
from heapq import heappop, heappush
from itertools import count
from random import Random

import numpy as np

from mend.fleet.dispatch.booking import AnyRequest
from mend.fleet.dispatch.cabins import Cabins
from mend.fleet.dispatch.discrete_execution import LegTimes
from mend.fleet.dispatch.setting import FleetSetting
from mend.fleet.dispatch.trip_times import TripTimes
from mend.fleet.requests import LegAction, Terms
from mend.maps.building.building import Building, Caller


class Sharing(StrEnum):
    """How what is asked for is shared out."""

    FIRST_COME = "first come, first served"
    LOWEST_BID = "lowest bid"


@dataclass(slots=True)
class PlainRobot:
    """Where a robot is, whether it works, and what it was given.

    `bid_place` and `bid_s` (seconds): where and when it expects to have done all that.
    """

    place: int
    speed: float
    bid_place: int
    bid_s: float = 0.0
    busy: bool = False
    given: list[AnyRequest] = field(default_factory=list)


class OneTaskAtATime:
    """A fleet that does one request at a time; `done_s` says when each was done."""

    def __init__(
        self,
        building: Building,
        setting: FleetSetting,
        trips: TripTimes,
        times: LegTimes,
        sharing: Sharing,
        chance: Random,
    ) -> None:
        graph = building.graph
        self._floors = [place.floor for place in graph.places]
        self._names = [place.name for place in graph.places]
        _, self._travel_s = graph.shortest(setting.speed_m_s)
        self._elevators = building.document.elevators
        most = max(each.capacity for each in setting.robots)
        self._terms = Terms(
            lambda name: self._names.index(building.find(name)), setting.handling_s, most
        )
        starts = [self._terms.place(each.start) for each in setting.robots]
        self.robots = [
            PlainRobot(start, each.speed, start)
            for start, each in zip(starts, setting.robots, strict=True)
        ]
        self._trips, self._cabins = trips, Cabins(building)
        self._times, self._sharing, self._chance = times, sharing, chance
        self._events: list[tuple[float, int, Callable[[], None]]] = []
        self._numbers, self._now_s = count(), 0.0
        self._waiting: list[AnyRequest] = []
        self.done_s: dict[str, float] = {}
        self.driven_m = 0.0

    def work_off(self, asked: Sequence[tuple[float, AnyRequest]]) -> None:
        """Do all that is asked for, in the order in which it is."""
        for asked_s, request in asked:
            self._call_at(asked_s, partial(self._take_in, request))
        while self._events:
            self._now_s, _, call = heappop(self._events)
            call()
            self._hand_out()

    def _call_at(self, time_s: float, call: Callable[[], None]) -> None:
        heappush(self._events, (time_s, next(self._numbers), call))

    def _take_in(self, request: AnyRequest) -> None:
        if self._sharing is Sharing.FIRST_COME:
            self._waiting.append(request)
        else:
            self._award(request, self._now_s)

    def _hand_out(self) -> None:
        """Have free robots begin."""
        for robot in self.robots:
            if robot.given and not robot.busy:
                self._begin(robot, robot.given.pop(0))
        while self._waiting and (free := [each for each in self.robots if not each.busy]):
            begins = self._stops(self._waiting[0])[0][0]
            away_s = [self._travel_s[each.place, begins] for each in free]
            self._begin(free[int(np.argmin(away_s))], self._waiting.pop(0))

    def _begin(self, robot: PlainRobot, request: AnyRequest) -> None:
        robot.busy = True
        self._go_on(robot, self._work(robot, request))

    def _go_on(self, robot: PlainRobot, work: Iterator[float]) -> None:
        """Let a robot work until it has to wait for a time to come."""
        for until_s in work:
            self._call_at(until_s, partial(self._go_on, robot, work))
            return
        robot.busy = False
        robot.bid_s = max(robot.bid_s, self._now_s) if robot.given else self._now_s

    def _award(self, request: AnyRequest, now_s: float) -> None:
        """To the robot that says that it has it done first."""
        bids = [self._bid_s(each, request, now_s) for each in self.robots]
        robot = self.robots[int(np.argmin(bids))]
        robot.given.append(request)
        robot.bid_s, robot.bid_place = min(bids), self._stops(request)[-1][0]

    def _bid_s(self, robot: PlainRobot, request: AnyRequest, now_s: float) -> float:
        """When a robot expects to have done a request, with the waiting that is usual."""
        times = self._times
        here, time_s = robot.bid_place, max(robot.bid_s, now_s)
        for place, lasts_s, needs_person in self._stops(request):
            time_s += self._travel_s[here, place] / robot.speed + lasts_s
            time_s += times.start_share * times.start_mean_s
            time_s += times.blocked_share * times.blocked_mean_s
            time_s += times.elevator_mean_s if self._floors[here] != self._floors[place] else 0.0
            time_s += times.end_mean_s if needs_person else 0.0
            here = place
        return time_s

    def _stops(self, request: AnyRequest) -> list[tuple[int, float, bool]]:
        """Where it leads, for how long, and whether somebody has to come."""
        item = request.item(request.name, self._terms)
        needs_person = request.fetching is not LegAction.VISIT
        first = (item.pickup.place, item.pickup.service_s, needs_person)
        if request.is_visit:
            return [first]
        return [first, (item.delivery.place, item.delivery.service_s, True)]

    def _work(self, robot: PlainRobot, request: AnyRequest) -> Iterator[float]:
        """Do a request; tells each time until which it has to wait, once it is `_now_s`."""
        times = self._times
        for place, lasts_s, needs_person in self._stops(request):
            yield self._now_s + self._wait_s(times.start_share, times.start_mean_s)
            trip = self._trips.trip(self._names[robot.place], self._names[place])
            for stage in trip:
                driving_s = stage.drives_s / robot.speed + self._wait_s(1.0, times.detour_mean_s)
                driving_s += self._wait_s(times.blocked_share, times.blocked_mean_s)
                for _ in range(stage.doors):
                    driving_s += self._wait_s(times.door_share, times.door_mean_s)
                self.driven_m += stage.drives_m
                yield self._now_s + driving_s
                if stage.ride is not None:
                    yield self._now_s + self._pressed_s(stage.ride.elevator)
                    ride = self._cabins.take(stage.ride, self._now_s)
                    yield self._now_s + ride.waits_s + ride.rides_s
            robot.place = place
            yield self._now_s + lasts_s + self._wait_s(float(needs_person), times.end_mean_s)
        self.done_s[request.name] = self._now_s

    def _pressed_s(self, elevator: str) -> float:
        by_people = self._elevators[elevator].called_by is Caller.PEOPLE
        return self._wait_s(float(by_people), self._times.elevator_mean_s)

    def _wait_s(self, share: float, mean_s: float) -> float:
        if mean_s == 0.0 or self._chance.random() >= share:
            return 0.0
        return self._chance.expovariate(1.0 / mean_s)
