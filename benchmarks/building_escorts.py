"""Robots that escort people through buildings: do both arrive, and is anybody touched?

    python benchmarks/building_escorts.py [--buildings 10] [--first 0] [--robots 2]
        [--seconds 600] [--localizer enml|exact] [--unmapped 0.2] [--dawdling 0.3] [--no-shows 0.1]
        [--people 0] [--building FILE ...]

Draws buildings by seeds, or takes those of files, each with as many seeds. Each robot meets
somebody at a drawn room, leads them to another, and does so again. Half of the doors that people
open are shut at first. Whoever is asked does what the robot asks for, 2 s later, and the robot
looks whether that is so; what it does not see in 60 s is a failure. An escort has arrived if robot
and person really stand within 2 m of each other, on one floor, within 3 m of the destination, when
the robot says that it is done; `said, and not so` counts the others. `led` counts the seconds in
which a robot led somebody, and `ahead` those of them in which it drove although the person had been
more than 3.3 m away, or out of sight, for longer than 1.5 s (standing takes a second; not while it
leaves an elevator). The exit code is 1 where a robot touched anything, or anybody.
"""

# ruff: noqa: T201
import argparse
import math
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from building_bench import BuildingBench, made_up

from mend.errors import MendError
from mend.maps.building.building_file import read_building_file
from mend.robots.base.behaviors.driving import CLEARS_M
from mend.robots.link.messages import (
    Finished,
    Interrupt,
    IssueDetected,
    Look,
    Looked,
    Rejected,
    Resume,
    StepStarted,
)
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Scene

SHUT_DOORS = 0.5
THINKS_S, LOOKS_S, SLICE_S = 2.0, 60.0, 0.25
BESIDE_M, AT_M = 2.0, 3.0
FAR_M, FAR_S = 3.3, 1.5
DRIVES_M_S = 0.05
PEOPLE_ISSUES = ("person_not_there", "fell_behind")


@dataclass
class Errand:
    """Whom a robot escorts from where to where; `meets`: it has not met them yet."""

    person: str
    origin: str
    destination: str
    meets: bool = True


class Escorts:
    """Has the robots of one scene escort one person after the other."""

    def __init__(self, scene: Scene, seed: int, options: argparse.Namespace) -> None:
        self._bench = BuildingBench(
            scene,
            shut_doors=SHUT_DOORS,
            seed=seed,
            localizer=options.localizer,
            unmapped=options.unmapped,
            people=options.people,
            no_shows=options.no_shows,
            dawdling=options.dawdling,
        )
        self._rng = np.random.default_rng([seed, 2])
        self._errands: dict[str, Errand] = {}
        self._held: dict[str, IssueDetected] = {}
        self._asked_s: dict[str, float] = {}
        self._away_s: Counter[str] = Counter()
        self._rode_at: dict[str, tuple[float, float]] = {}
        self._read = 0
        self.counts: Counter[str] = Counter()
        self.nearest_m = math.inf

    @property
    def touches(self) -> int:
        return self._bench.world.touches

    def run(self, seconds: float) -> None:
        """Let so much of the world's time pass."""
        for robot in self._bench.scene.robots:
            self._send_on(robot)
        while self._bench.group.time_s() < seconds:
            # While all robots wait for an answer, the world's clock stands still.
            goes_on = self._bench.group.advance(SLICE_S)
            self._measure()
            self._hear()
            self._answer(at_once=not goes_on)
        self.counts["under way at the end"] = len(self._errands)

    def _send_on(self, robot: str) -> None:
        rooms = sorted(each for each in self._bench.scene.places if "charger" not in each)
        a, b = self._rng.permutation(len(rooms))[:2]
        number = self.counts["begun"] = self.counts["begun"] + 1
        errand = self._errands[robot] = Errand(f"guest {number}", rooms[int(a)], rooms[int(b)])
        self._bench.go(robot, errand.origin, "meet_person", person=errand.person)

    # --- What is so -----------------------------------------------------------------------------

    def _measure(self) -> None:
        """How near people come to robots, and whether robots drive on without who follows."""
        world = self._bench.world
        people = [e.at for e in (*world.walkers.people, *world.guests.there.values())]
        for number, (name, robot) in enumerate(
            zip(self._bench.scene.robots, world.robots, strict=True)
        ):
            for at in people:
                if at.floor == robot.at.floor:
                    away_m = math.hypot(at.x - robot.at.x, at.y - robot.at.y)
                    self.nearest_m = min(self.nearest_m, away_m - robot.radius_m - RADIUS_M)
            guest = world.guests.there.get(number)
            if guest is None or not guest.led:
                self._away_s[name] = 0.0
                continue
            self.counts["s led"] += SLICE_S  # type: ignore[assignment]
            beside = self._is_beside(number, FAR_M)
            seen = world.companions[number].sighting() is not None
            leaves = self._leaves_cabin(name, robot.at.x, robot.at.y, robot.at.floor)
            if leaves or (beside and seen):
                self._away_s[name] = 0.0
            else:
                self._away_s[name] += SLICE_S
                if self._away_s[name] > FAR_S and robot.velocity().speed_m_s > DRIVES_M_S:
                    self.counts["s ahead"] += SLICE_S  # type: ignore[assignment]

    def _leaves_cabin(self, name: str, x: float, y: float, floor: str) -> bool:
        world = self._bench.world
        if floor.startswith("/") or world.elevators.is_in_a_cabin(floor, x, y, 0.0):
            self._rode_at[name] = x, y
        return name in self._rode_at and math.dist(self._rode_at[name], (x, y)) < CLEARS_M + 1.0

    def _is_beside(self, number: int, within_m: float) -> bool:
        world = self._bench.world
        guest, at = world.guests.there.get(number), world.robots[number].at
        if guest is None or guest.at.floor != at.floor:
            return False
        return math.hypot(guest.at.x - at.x, guest.at.y - at.y) <= within_m

    def _is_at(self, number: int, place: str) -> bool:
        at, pose = self._bench.world.robots[number].at, self._bench.scene.places[place].pose
        height_m = self._bench.world.building.floors[at.floor].height
        same = abs((pose.z or 0.0) - height_m) < 0.5
        return same and math.hypot(pose.x - at.x, pose.y - at.y) <= AT_M

    # --- What robots report ---------------------------------------------------------------------

    def _hear(self) -> None:
        new, self._read = self._bench.reports[self._read :], len(self._bench.reports)
        for robot, body in new:
            match body:
                case Finished():
                    self._finished(robot)
                case Rejected():
                    self.counts[f"rejected: {body.reason}"] += 1
                    self._send_on(robot)
                case StepStarted() if not body.name.startswith("go to"):
                    self._rode_at.pop(robot, None)
                case IssueDetected():
                    self.counts[body.issue] += 1
                    self._held[robot] = body
                    self._asked_s[robot] = self._bench.group.time_s() + THINKS_S
                case Looked() if robot in self._held:
                    self._looked(robot, body)

    def _finished(self, robot: str) -> None:
        errand = self._errands[robot]
        number = list(self._bench.scene.robots).index(robot)
        if errand.meets:
            errand.meets = False
            self.counts["met"] += 1
            self._bench.go(robot, errand.destination, "escort", person=errand.person)
            return
        together = self._is_beside(number, BESIDE_M + 0.3)
        there = together and self._is_at(number, errand.destination)
        self.counts["arrived together" if there else "said, and not so"] += 1
        self._send_on(robot)

    def _looked(self, robot: str, looked: Looked) -> None:
        held = self._held.pop(robot)
        if looked.fulfilled:
            self._bench.send(robot, Resume(execution=held.execution))
            return
        self.counts[f"given up: {held.issue}"] += 1
        self._bench.send(robot, Interrupt(retreat=True))
        self._send_on(robot)

    def _answer(self, *, at_once: bool) -> None:
        now_s = math.inf if at_once else self._bench.group.time_s()
        for robot in [each for each, at_s in self._asked_s.items() if at_s <= now_s]:
            del self._asked_s[robot]
            issue = self._held[robot].issue
            act = Act.SEND_PERSON if issue in PEOPLE_ISSUES else Act.RELEASE
            self._bench.world.intervene(Intervention(act=act))
            expected = {"lost": "located"}.get(issue, "way_clear")
            expected = "accompanied" if issue in PEOPLE_ISSUES else expected
            look = Look.model_validate({"expect": expected, "within_s": LOOKS_S})
            self._bench.send(robot, look)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--buildings", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--robots", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--localizer", choices=["enml", "exact"], default="exact")
    parser.add_argument("--unmapped", type=float, default=0.0)
    parser.add_argument("--dawdling", type=float, default=0.3)
    parser.add_argument("--no-shows", type=float, default=0.1)
    parser.add_argument("--people", type=int, default=0)
    parser.add_argument("--building", type=Path, nargs="*", default=[])
    arguments = parser.parse_args()
    total: Counter[str] = Counter()
    touches, nearest_m = 0, math.inf
    for name, seed, scene in _scenes(arguments):
        escorts = Escorts(scene, seed, arguments)
        escorts.run(arguments.seconds)
        print(
            f"{name}: {escorts.touches} touches, nearest {escorts.nearest_m:.2f} m, "
            f"{_told(escorts.counts)}",
            flush=True,
        )
        touches += escorts.touches
        nearest_m = min(nearest_m, escorts.nearest_m)
        total += escorts.counts
    print(f"all: {touches} touches, nearest {nearest_m:.2f} m, {_told(total)}")
    return 1 if touches or nearest_m < 0.0 else 0


def _scenes(options: argparse.Namespace) -> Iterator[tuple[str, int, Scene]]:
    seeds = range(options.first, options.first + options.buildings)
    for file in options.building:
        try:
            scene = scene_of(read_building_file(file), "escorts", options.robots)
        except MendError as error:
            raise SystemExit(str(error)) from error
        for seed in seeds:
            yield f"{file.stem}, seed {seed}", seed, scene
    for seed in () if options.building else seeds:
        building = made_up(1 + seed % 4, 6 + seed % 15, seed)
        yield f"seed {seed}", seed, scene_of(building, "escorts", options.robots)


def _told(counts: Counter[str]) -> str:
    return ", ".join(f"{count:g} {what}" for what, count in sorted(counts.items()))


if __name__ == "__main__":
    sys.exit(main())
