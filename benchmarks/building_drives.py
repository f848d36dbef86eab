"""Robots that drive through buildings from goal to goal: do they arrive, do they touch anything?

    python benchmarks/building_drives.py [FILE...] [--buildings 10] [--first 0] [--robots 3]
        [--seconds 300] [--localizer enml|exact] [--unmapped 0.33] [--carried-every 0] [--lies 0.0]
        [--people 0]

Without building files it draws buildings by seeds. Half of the doors that people open are shut at
first, and every now and then somebody steps in the way of a robot. Whoever is asked makes way, or
opens the door, or presses the elevator's button (one time in five a wrong one), 2 s later; the
robot looks whether that is so, and goes on. A drive that does not
end at its goal is counted with the reason. With `--carried-every` somebody carries a robot that
drives to elsewhere on its floor, about every so many seconds. With `--people` so many walk about.
A robot that is lost asks where it is; the answer is what is so, or with the chance `--lies` the
contrary. How far off robots were while they did not say that they were lost is told, and `silent`
counts how often one was more than 2 m off for longer than 2 s without having said so. The exit
code is 1 where a robot touched anything.
"""

# ruff: noqa: T201
import argparse
import math
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from believed_poses import BelievedPoses
from building_bench import BuildingBench, made_up

from mend.maps.building.building_file import read_building_file
from mend.maps.building.crossing import crossed_by
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
from mend.tasks.scene import Scene

SHUT_DOORS = 0.5
WRONG_FLOORS = 0.2
STEPS_IN_EVERY_S = 20.0
THINKS_S = 2.0
LOOKS_S = 60.0
SLICE_S = 0.25
NEAR_M = 1.0
"""So much farther than to the nearest place people still call it near."""
AT_M = 4.0


class Drives:
    """Sends the robots of one scene from goal to goal, and has people do what they are asked."""

    def __init__(self, scene: Scene, seed: int, options: argparse.Namespace) -> None:
        self._bench = BuildingBench(
            scene,
            shut_doors=SHUT_DOORS,
            wrong_floors=WRONG_FLOORS,
            seed=seed,
            localizer=options.localizer,
            unmapped=options.unmapped,
            carried_every_s=options.carried_every,
            people=options.people,
        )
        self._rng = np.random.default_rng([seed, 1])
        self._lies = options.lies
        self._held: dict[str, str] = {}
        self._asked_s: dict[str, float] = {}
        self._guesses: dict[str, list[str]] = {}
        self._read = 0
        self.counts: Counter[str] = Counter()
        self.poses = BelievedPoses(self._bench.world.robots)

    @property
    def touches(self) -> int:
        return self._bench.world.touches

    def run(self, seconds: float) -> None:
        """Let so much of the world's time pass."""
        group, steps_in_s = self._bench.group, STEPS_IN_EVERY_S
        for robot in self._bench.scene.robots:
            self._send_on(robot)
        while group.time_s() < seconds:
            group.advance(SLICE_S)
            if group.time_s() >= steps_in_s:
                steps_in_s += self._rng.uniform(0.5, 1.5) * STEPS_IN_EVERY_S
                if self._bench.world.intervene(Intervention(act=Act.BLOCK)) == "":
                    self.counts["steps in the way"] += 1
            self.poses.look(group.time_s(), SLICE_S)
            self._hear()
            self._answer()
        self.counts["carried"] = self._bench.world.carried
        self.counts += self.poses.silent

    def _send_on(self, robot: str) -> None:
        """To any place of the building."""
        goals = sorted(self._bench.scene.places)
        self.counts["drives"] += 1
        self._bench.go(robot, goals[int(self._rng.integers(len(goals)))])

    def _hear(self) -> None:
        """What the robots reported since."""
        new, self._read = self._bench.reports[self._read :], len(self._bench.reports)
        for robot, body in new:
            match body:
                case Finished():
                    self.counts["arrived"] += 1
                    self._send_on(robot)
                case Rejected():
                    self.counts[f"rejected: {body.reason}"] += 1
                    self._send_on(robot)
                case IssueDetected():
                    self.counts[body.issue] += 1
                    self._guesses.pop(robot, None)
                    if body.issue == "lost" and body.detection is not None:
                        self._guesses[robot] = list(body.detection.guesses)
                    self._held[robot] = body.execution
                    self._asked_s[robot] = self._bench.group.time_s() + THINKS_S
                case Looked() if not body.fulfilled and robot in self._guesses:
                    self._asked_s[robot] = self._bench.group.time_s() + THINKS_S
                case Looked() if body.fulfilled:
                    if robot in self._guesses:
                        self.counts["found again"] += 1
                    self._bench.send(robot, Resume(execution=self._held.pop(robot)))
                case Looked():
                    del self._held[robot]
                    self.counts["given up, not helped"] += 1
                    self._bench.send(robot, Interrupt(retreat=True))
                    self._send_on(robot)

    def _answer(self) -> None:
        now_s = self._bench.group.time_s()
        for robot in [each for each, at_s in self._asked_s.items() if at_s <= now_s]:
            del self._asked_s[robot]
            if robot in self._guesses:
                self._tell_where(robot)
                continue
            self._bench.world.intervene(Intervention(act=Act.RELEASE))
            self._bench.send(robot, Look(expect="way_clear", within_s=LOOKS_S))

    def _tell_where(self, robot: str) -> None:
        """Answer its questions in turn, until one is said yes to."""
        guesses = self._guesses[robot]
        while guesses:
            guess = guesses.pop(0)
            lies = self._rng.random() < self._lies
            if self._is_true(robot, guess) != lies:
                if lies:
                    self.counts["lies"] += 1
                    self.poses.lied_to.add(list(self._bench.scene.robots).index(robot))
                self.counts["told"] += 1
                self._bench.send(robot, Look(expect="located", guess=guess, within_s=LOOKS_S))
                return
        del self._guesses[robot]
        self.counts["nothing true to say yes to"] += 1
        self._bench.send(robot, Look(expect="located", within_s=0.0))

    def _is_true(self, robot: str, guess: str) -> bool:
        """Whether people would say that it is so."""
        names = list(self._bench.scene.robots)
        at = self._bench.world.robots[names.index(robot)].at
        if at.floor not in self._bench.world.building.floors:
            return False
        how, name = guess.split(" ", 1)
        floor = self._bench.world.building.floors[at.floor]
        away_m = {
            each: math.hypot(place.pose.x - at.x, place.pose.y - at.y)
            for each, place in self._bench.scene.places.items()
            if abs((place.pose.z or 0.0) - floor.height) < 0.5
        }
        if how == "near":
            return away_m[name] <= min(away_m.values()) + NEAR_M
        pose = self._bench.scene.places[name].pose
        between = crossed_by(np.array([at.x, at.y, pose.x, pose.y]), floor.vector_map.segments)
        return away_m[name] <= AT_M and not len(between)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--buildings", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--robots", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--localizer", choices=["enml", "exact"], default="exact")
    parser.add_argument("--unmapped", type=float, default=0.0)
    parser.add_argument("--carried-every", type=float, default=0.0)
    parser.add_argument("--people", type=int, default=0)
    parser.add_argument("--lies", type=float, default=0.0)
    arguments = parser.parse_args()
    scenes = [
        (each.stem, scene_of(read_building_file(each), "drives", arguments.robots))
        for each in arguments.files
    ] or [
        (
            f"seed {seed}",
            scene_of(made_up(1 + seed % 4, 6 + seed % 15, seed), "drives", arguments.robots),
        )
        for seed in range(arguments.first, arguments.first + arguments.buildings)
    ]
    total: Counter[str] = Counter()
    touches, poses = 0, BelievedPoses([])
    for number, (name, scene) in enumerate(scenes):
        began_s = time.process_time()
        drives = Drives(scene, arguments.first + number, arguments)
        drives.run(arguments.seconds)
        pace = arguments.seconds / (time.process_time() - began_s)
        print(
            f"{name}: {drives.touches} touches, {_told(drives.counts)}{drives.poses.told}; "
            f"{pace:.1f} x real time",
            flush=True,
        )
        poses.off_m += drives.poses.off_m
        total += drives.counts
        touches += drives.touches
    print(f"all {len(scenes)}: {touches} touches, {_told(total)}{poses.told}")
    return 1 if touches else 0


def _told(counts: Counter[str]) -> str:
    return ", ".join(f"{count} {what}" for what, count in sorted(counts.items()))


if __name__ == "__main__":
    sys.exit(main())
