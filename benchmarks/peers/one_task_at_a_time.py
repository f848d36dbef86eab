"""The plain ways of sharing out what is asked for: each robot does one request at a time.

First come, first served: whenever a robot is free, the request that has waited longest goes to
the free robot that is nearest to where it begins. Lowest bid, as Open-RMF's dispatcher awards its
tasks: each request is put up as soon as it is made, every robot says when it would have done it,
after what it was given before and in that order, and the earliest has it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from heapq import heappop, heappush
from random import Random

import numpy as np
from numpy.typing import NDArray

from mend.fleet.dispatch.booking import AnyRequest
from mend.fleet.dispatch.drawn_execution import LegTimes
from mend.fleet.dispatch.setting import FleetSetting
from mend.fleet.requests import LegAction, Terms
from mend.maps.building.building import Building

Matrix = NDArray[np.float64]


class Sharing(StrEnum):
    """How what is asked for is shared out."""

    FIRST_COME = "first come, first served"
    LOWEST_BID = "lowest bid"


@dataclass(slots=True)
class PlainRobot:
    """Where a robot will be once it is free, and what it was given; times in seconds."""

    place: int
    speed: float
    free_s: float = 0.0
    bid_place: int = 0
    bid_s: float = 0.0
    given: list[str] = field(default_factory=list)


class OneTaskAtATime:
    """A fleet that does one request at a time; `done_s` says when each was done."""

    def __init__(
        self,
        building: Building,
        setting: FleetSetting,
        times: LegTimes,
        sharing: Sharing,
        chance: Random,
    ) -> None:
        graph = building.graph
        self._floors = [place.floor for place in graph.places]
        self._distance_m, self._travel_s = graph.shortest(setting.speed_m_s)
        names = [place.name for place in graph.places]
        most = max(each.capacity for each in setting.robots)
        self._terms = Terms(lambda name: names.index(building.find(name)), setting.handling_s, most)
        starts = [self._terms.place(each.start) for each in setting.robots]
        self.robots = [
            PlainRobot(start, each.speed, bid_place=start)
            for start, each in zip(starts, setting.robots, strict=True)
        ]
        self._times, self._sharing, self._chance = times, sharing, chance
        self.done_s: dict[str, float] = {}
        self.driven_m = 0.0

    def work_off(self, asked: Sequence[tuple[float, AnyRequest]]) -> None:
        """Do all that is asked for, in the order in which it is."""
        requests: Mapping[str, AnyRequest] = {each.name: each for _, each in asked}
        events: list[tuple[float, int, str]] = []
        for number, (asked_s, request) in enumerate(asked):
            heappush(events, (asked_s, number, request.name))
        waiting: list[str] = []
        while events:
            now_s, _, name = heappop(events)
            if name and self._sharing is Sharing.FIRST_COME:
                waiting.append(name)
            elif name:
                self._award(requests[name], now_s)
            for begin in self._begins(waiting, requests, now_s):
                heappush(events, (begin, len(requests), ""))

    def _begins(
        self, waiting: list[str], requests: Mapping[str, AnyRequest], now_s: float
    ) -> list[float]:
        """Have free robots begin; when each is free again."""
        ends = []
        if self._sharing is Sharing.LOWEST_BID:
            for robot in self.robots:
                if robot.given and robot.free_s <= now_s:
                    ends.append(self._do(robot, requests[robot.given.pop(0)], now_s))
            return ends
        while waiting:
            free = [each for each in self.robots if each.free_s <= now_s]
            if not free:
                break
            request = requests[waiting.pop(0)]
            begins = self._stops(request)[0][0]
            away_s = [self._travel_s[each.place, begins] for each in free]
            ends.append(self._do(free[int(np.argmin(away_s))], request, now_s))
        return ends

    def _award(self, request: AnyRequest, now_s: float) -> None:
        """To the robot that says that it has it done first."""
        bids = [self._bid_s(each, request, now_s) for each in self.robots]
        robot = self.robots[int(np.argmin(bids))]
        robot.given.append(request.name)
        robot.bid_s, robot.bid_place = min(bids), self._stops(request)[-1][0]

    def _bid_s(self, robot: PlainRobot, request: AnyRequest, now_s: float) -> float:
        """When a robot expects to have done a request, with the waiting that is usual."""
        times = self._times
        here, time_s = robot.bid_place, max(robot.bid_s, robot.free_s, now_s)
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

    def _do(self, robot: PlainRobot, request: AnyRequest, now_s: float) -> float:
        """Draw how long a request takes; when its robot is free again."""
        times, time_s = self._times, now_s
        for place, lasts_s, needs_person in self._stops(request):
            rides = self._floors[robot.place] != self._floors[place]
            factor = self._chance.lognormvariate(0.0, times.drive_spread)
            time_s += self._travel_s[robot.place, place] / robot.speed * factor + lasts_s
            time_s += self._wait_s(times.start_share, times.start_mean_s)
            time_s += self._wait_s(1.0 if rides else 0.0, times.elevator_mean_s)
            time_s += self._wait_s(times.blocked_share, times.blocked_mean_s)
            time_s += self._wait_s(1.0 if needs_person else 0.0, times.end_mean_s)
            self.driven_m += self._distance_m[robot.place, place]
            robot.place = place
        robot.free_s = self.done_s[request.name] = time_s
        return time_s

    def _wait_s(self, share: float, mean_s: float) -> float:
        if mean_s == 0.0 or self._chance.random() >= share:
            return 0.0
        return self._chance.expovariate(1.0 / mean_s)
