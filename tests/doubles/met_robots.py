"""Robots of a made-up building that are told when they meet, as a fleet's service tells them."""

from collections.abc import Mapping

from building_bench import BuildingBench

from mend.robots.link.messages import MakeWay
from mend.server.fleets.meetings import Meetings, Occupation
from mend.sim.building.setting import building_of
from mend.tasks.frames import frames_of

EVERY_S = 0.5


class MetRobots:
    """Looks where robots are every half second, and tells them what they are to do.

    `goals`: the place that each is on its way to, as `FLOOR/PLACE`; who is not in it rests.
    """

    def __init__(self, bench: BuildingBench, goals: Mapping[str, str]) -> None:
        building = building_of(bench.scene)
        places = [each.name for each in building.graph.places]
        self._bench, self._goals = bench, goals
        bases = {each.name: each.hello("1").base for each in bench.group.agents}
        self._meetings = Meetings(
            building, frames_of(bench.scene), places, self._occupation, bases.get
        )
        self._looks_s = 0.0
        self.told: list[tuple[str, MakeWay]] = []
        self.sent: list[tuple[str, str | None]] = []
        """Who is asked to go elsewhere, as it rests where another one comes, and where to."""

    def advance(self, duration_s: float) -> bool:
        """Let so much time pass; False when nothing is under way."""
        going_on = self._bench.group.advance(min(duration_s, EVERY_S))
        met = [self._meetings.take(e.name, e.poses()) for e in self._bench.group.agents]
        now_s = self._bench.group.time_s()
        if any(met) and now_s >= self._looks_s:
            self._looks_s = now_s + EVERY_S
            self._resolve(now_s)
        return going_on

    def _resolve(self, now_s: float) -> None:
        standings = self._meetings.standings()
        decided = self._meetings.decide(standings, now_s)
        if decided is None:
            return
        if self._meetings.rests(decided.robot):
            self.sent.append((decided.robot, self._meetings.place_to_rest(decided, standings)))
            return
        for robot, told in self._meetings.told(decided, now_s):
            self.told.append((robot, told))
            self._bench.send(robot, told)

    def _occupation(self, robot: str) -> Occupation:
        goal = self._goals.get(robot)
        return Occupation(goal=goal, rests=goal is None)
