"""Many robots in the corridors of a building: how many drives an hour, and does one stand for ever?

    python benchmarks/building_corridors.py PLAN... [--robots 2 8 20] [--seconds 600] [--seed 0]
        [--untold]

PLAN: building files (`mend building import` makes them). Whoever has arrived is sent to the next
place of one list, drawn by the seed, that no other robot is sent to or stands at; places are all
of the plan but cabins. Ours drive in the simulated building by their lasers, and are told when they
meet as a fleet's service tells them (not with `--untold`); who is asked something does what helps,
2 s later. The peer, in the same run with the same list, is prioritized
planning (`peers/cooperative_astar.py`): its robots start and stop at once, are never off, and try
again every 5 s where there is no path.
A robot stands for ever if it has not moved by 0.3 m for 180 s. The exit code is 1 if one does.
"""

# ruff: noqa: T201
import argparse
import math
import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from building_bench import BuildingBench
from met_robots import MetRobots
from peers.cooperative_astar import Planned

from mend.errors import WrongInputError
from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.building_file import read_building_file
from mend.robots.link.messages import (
    Finished,
    Interrupt,
    IssueDetected,
    Look,
    Looked,
    Rejected,
    Resume,
)
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import MOST_ROBOTS, Place, Pose, Scene

SLICE_S = 0.5
THINKS_S = 2.0
LOOKS_S = 60.0
TRIES_EVERY_S = 5
STANDS_M, STANDS_S = 0.3, 180.0


class Goals:
    """One endless list of places; each goes to the first robot that may be sent there."""

    def __init__(self, places: list[str], seed: int) -> None:
        self._list = self._drawn(places, Random(seed))
        self._waiting: list[str] = []
        self.of: dict[str, str] = {}

    @staticmethod
    def _drawn(places: list[str], chance: Random) -> Iterator[str]:
        while True:
            yield chance.choice(places)

    def next_for(self, robot: str) -> str:
        """Not the goal of anybody, nor where they stand: that is what their goal was."""
        for each in self._waiting:
            if each not in self.of.values():
                self._waiting.remove(each)
                break
        else:
            while (each := next(self._list)) in self.of.values():
                self._waiting.append(each)
        self.of[robot] = each
        return each


@dataclass
class Tally:
    """What became of the drives."""

    arrived: int = 0
    stood: set[str] = field(default_factory=set)
    counts: Counter[str] = field(default_factory=Counter)
    took_s: float = 0.0


def everywhere(building: Building, robots: int) -> tuple[Scene, dict[str, str]]:
    """A scene in which every place but the cabins is one, and what each is called there."""
    scene = scene_of(building, "corridors", robots)
    places, called = {}, {}
    for number, each in enumerate(building.graph.places):
        floor = each.name.split("/", 1)[0]
        if each.name not in building.of_kind(PlaceKind.ELEVATOR):
            called[each.name] = f"p{number}"
            height = building.floors[floor].height
            places[f"p{number}"] = Place(pose=Pose(x=each.x_m, y=each.y_m, z=height))
    return scene.model_copy(update={"places": places}), called


class Driving:
    """Ours: robots of the simulated building, and somebody who helps whoever asks."""

    def __init__(
        self,
        scene: Scene,
        goals: Goals,
        called: dict[str, str],
        starts: dict[str, str],
        seed: int,
        *,
        told: bool,
    ) -> None:
        self._bench = BuildingBench(scene, seed=seed)
        self._goals, self._called = goals, called
        goals.of.update(starts)
        self._met = MetRobots(self._bench, goals.of)
        self._told = told
        self._read = 0
        self._held: dict[str, str] = {}
        self._asked_s: dict[str, float] = {}
        self._stands: dict[str, tuple[float, float, str, float]] = {}
        self.tally = Tally()

    def run(self, seconds: float) -> Tally:
        """Let so much of the world's time pass."""
        began_s, group = time.process_time(), self._bench.group
        for robot in self._bench.scene.robots:
            self._send_on(robot)
        while group.time_s() < seconds:
            (self._met if self._told else group).advance(SLICE_S)
            self._hear()
            self._help()
            self._judge()
        self.tally.took_s = time.process_time() - began_s
        self.tally.counts["touches"] = self._bench.world.touches
        self.tally.counts["made way"] = len(self._met.told) // 2
        return self.tally

    def _send_on(self, robot: str) -> None:
        self._bench.go(robot, self._called[self._goals.next_for(robot)])

    def _hear(self) -> None:
        new, self._read = self._bench.reports[self._read :], len(self._bench.reports)
        for robot, body in new:
            match body:
                case Finished():
                    self.tally.arrived += 1
                    self._send_on(robot)
                case Rejected():
                    self.tally.counts[f"rejected: {body.reason}"] += 1
                    self._send_on(robot)
                case IssueDetected():
                    self.tally.counts[body.issue] += 1
                    self._held[robot] = body.execution
                    self._asked_s[robot] = self._bench.group.time_s() + THINKS_S
                case Looked() if body.fulfilled:
                    self._bench.send(robot, Resume(execution=self._held.pop(robot)))
                case Looked():
                    del self._held[robot]
                    self.tally.counts["given up"] += 1
                    self._bench.send(robot, Interrupt(retreat=True))
                    self._send_on(robot)

    def _help(self) -> None:
        now_s = self._bench.group.time_s()
        for robot in [each for each, at_s in self._asked_s.items() if at_s <= now_s]:
            del self._asked_s[robot]
            self._bench.world.intervene(Intervention(act=Act.RELEASE))
            self._bench.send(robot, Look(expect="way_clear", within_s=LOOKS_S))

    def _judge(self) -> None:
        now_s = self._bench.group.time_s()
        for name, robot in zip(self._bench.scene.robots, self._bench.world.robots, strict=True):
            x, y, floor, since_s = self._stands.get(name, (math.inf, 0.0, "", now_s))
            at = robot.at
            if at.floor != floor or math.hypot(at.x - x, at.y - y) > STANDS_M:
                self._stands[name] = at.x, at.y, at.floor, now_s
            elif now_s - since_s > STANDS_S:
                self.tally.stood.add(name)


def planned(building: Building, goals: Goals, starts: dict[str, str], seconds: int) -> Tally:
    """The peer: whoever has arrived plans at once; who finds no path tries again later."""
    began_s, tally = time.process_time(), Tally()
    peer = Planned(building, starts)
    goals.of.update(starts)
    since_s = dict.fromkeys(starts, 0)
    tries_s = dict.fromkeys(starts, 0)
    wants: dict[str, str] = {}
    for now_s in range(seconds):
        peer.forget_before(now_s)
        for robot in starts:
            if peer.arrives_s(robot) > now_s or tries_s[robot] > now_s:
                continue
            if robot not in wants and now_s:
                tally.arrived += 1
            goal = wants[robot] if robot in wants else goals.next_for(robot)
            if peer.plan(robot, goal, now_s):
                wants.pop(robot, None)
                since_s[robot] = peer.arrives_s(robot)
                continue
            wants[robot], tries_s[robot] = goal, now_s + TRIES_EVERY_S
            if now_s - since_s[robot] > STANDS_S:
                tally.stood.add(robot)
    tally.took_s = time.process_time() - began_s
    return tally


def compare(plan: Path, robots: int, seconds: float, seed: int, *, told: bool) -> bool:
    """Print one row; whether none of ours stands for ever."""
    building = read_building_file(plan)
    if robots > MOST_ROBOTS:
        print(f"{plan.stem:16} {robots:3} robots: a scene has at most {MOST_ROBOTS}")
        return True
    try:
        scene, called = everywhere(building, robots)
    except WrongInputError as error:
        print(f"{plan.stem}: {error}")
        return True
    starts = {
        name: min(
            called,
            key=lambda each, base=base: _away(building, each, base.x, base.y, base.z),  # type: ignore[misc]
        )
        for name, base in scene.robots.items()
    }
    goals = Goals(list(called), seed)
    ours = Driving(scene, goals, called, starts, seed, told=told).run(seconds)
    peer = planned(building, Goals(list(called), seed), starts, int(seconds))
    hours = seconds / 3600.0
    ratio = ours.arrived / peer.arrived if peer.arrived else math.inf
    counts = ", ".join(f"{count} {what}" for what, count in sorted(ours.counts.items()) if count)
    print(
        f"{plan.stem:16} {robots:3} robots {ours.arrived / hours:7.0f} drives an hour, prioritized "
        f"planning {peer.arrived / hours:7.0f}: {ratio:.2f} x; stand for ever: {len(ours.stood)}, "
        f"{len(peer.stood)}; {ours.took_s:.0f} s, {peer.took_s:.0f} s of processor; {counts}",
        flush=True,
    )
    return not ours.stood


def _away(building: Building, place: str, x: float, y: float, z: float) -> float:
    floor, name = place.split("/", 1)
    at = building.floors[floor]
    away_m = math.hypot(at.places[name].x - x, at.places[name].y - y)
    return away_m if abs(at.height - z) < 0.5 else math.inf


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("plans", nargs="*", type=Path, metavar="PLAN")
    parser.add_argument("--robots", nargs="+", type=int, default=[2, 8, 20])
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--untold", action="store_true", help="nobody tells robots that they meet")
    options = parser.parse_args()
    if not options.plans:
        print("no building file was given: nothing is measured")
        return 0
    good = [
        compare(plan, robots, options.seconds, options.seed, told=not options.untold)
        for plan in options.plans
        for robots in options.robots
    ]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
