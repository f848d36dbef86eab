"""What robots find of ways, and what comes of it: a way is closed, or another robot goes."""

import math
from collections.abc import Callable

import numpy as np

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found, Leg
from mend.maps.building.clearance import distances_m
from mend.server.fleets.closed_ways import ClosedWays
from mend.server.fleets.robot_findings import is_led_round
from mend.tasks.potential import Point

ON_LANE_M = 0.6
"""Who is no farther from a lane stands on it."""
BEFORE_M = 1.5
"""Who stands before something is no farther from the middle of that."""


class FoundWays:
    """Tells one dispatcher what its robots find, each finding once.

    `whereabouts`: where a robot says that it is, in the frame of the building.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        closed: ClosedWays,
        whereabouts: Callable[[str], Point | None],
    ) -> None:
        self._dispatcher, self._closed = dispatcher, closed
        self._whereabouts = whereabouts
        self._told: dict[str, tuple[int, Finding, frozenset[str]]] = {}
        """By robot, what it has last found of which way, and on which leg."""

    def take(self, found: Found, now_s: float) -> bool:
        """Have the plan follow what a robot has found; whether it does.

        Raises a `RefusalError` for what makes no sense to it.
        """
        if found.finding is Finding.BLOCKED and self._is_barred_by_a_robot(found):
            # It goes on before long.
            return False
        legs = self._dispatcher.legs_under_way()
        leg = next((each for each in legs if each.robot == found.by), None)
        if self._is_told_already(found, leg):
            return False
        if self._is_news(found, leg):
            self._dispatcher.found(found, now_s)
        elif not self._is_taken_over(found, leg, now_s):
            return False
        self._closed.note(found, found.by)
        return True

    def _is_barred_by_a_robot(self, found: Found) -> bool:
        """Whether it is another robot that works before which the finder stands on the way."""
        here = None if found.by is None else self._whereabouts(found.by)
        if here is None:
            return False
        ends = (self._dispatcher.building.find(each) for each in found.between)
        a, b = (self._dispatcher.building.graph.place(each) for each in ends)
        lane, floor = np.array([[a.x_m, a.y_m, b.x_m, b.y_m]]), found.between[0].split("/", 1)[0]
        for name, robot in self._dispatcher.fleet.robots.items():
            at = self._whereabouts(name)
            if name == found.by or not robot.works or at is None:
                continue
            near = math.dist(here[:2], at[:2]) <= BEFORE_M
            on_floor = self._dispatcher.building.floor_at(at[2]) == floor
            if near and on_floor and distances_m(np.array([at[:2]]), lane)[0] < ON_LANE_M:
                return True
        return False

    def _is_told_already(self, found: Found, leg: Leg | None) -> bool:
        """Whether a robot has told others of it before, and asks people about it now."""
        if leg is None:
            return False
        told = (leg.number, found.finding, frozenset(found.between))
        before, self._told[leg.robot] = self._told.get(leg.robot), told
        return told == before and found.finding is not Finding.OPEN

    def _is_taken_over(self, found: Found, leg: Leg | None, now_s: float) -> bool:
        """Whether another robot does a leg on whose way its own does not get on."""
        if leg is None or found.finding is Finding.OPEN:
            return False
        return self._dispatcher.take_over(found, now_s) is not None

    def _is_news(self, found: Found, leg: Leg | None) -> bool:
        """Whether it is something for all others to go by."""
        closed, graph = self._dispatcher.closed_until_s(), self._dispatcher.building.graph
        if found.finding is Finding.OPEN:
            return frozenset(found.between) in closed
        return is_led_round(graph, closed, found, found.between[1] if leg is None else leg.place)
