"""Robots that drive through buildings from goal to goal: do they arrive, do they touch anything?

    python benchmarks/building_drives.py [FILE...] [--buildings 10] [--first 0] [--robots 3]
        [--seconds 300]

Without building files it draws buildings by seeds. Half of the doors that people open are shut at
first, and every now and then somebody steps in the way of a robot. Whoever is asked makes way, or
opens the door, or presses the elevator's button (one time in five a wrong one), 2 s later; the
robot looks whether that is so, and goes on. A drive that does not
end at its goal is counted with the reason. The exit code is 1 where a robot touched anything.
"""

# ruff: noqa: T201
import argparse
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from building_bench import BuildingBench, made_up

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
from mend.tasks.scene import Scene

SHUT_DOORS = 0.5
WRONG_FLOORS = 0.2
STEPS_IN_EVERY_S = 20.0
THINKS_S = 2.0
LOOKS_S = 60.0
SLICE_S = 0.25


class Drives:
    """Sends the robots of one scene from goal to goal, and has people do what they are asked."""

    def __init__(self, scene: Scene, seed: int) -> None:
        self._bench = BuildingBench(
            scene, shut_doors=SHUT_DOORS, wrong_floors=WRONG_FLOORS, seed=seed
        )
        self._rng = np.random.default_rng([seed, 1])
        self._held: dict[str, str] = {}
        self._asked_s: dict[str, float] = {}
        self._read = 0
        self.counts: Counter[str] = Counter()

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
            self._hear()
            self._answer()

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
                    self._held[robot] = body.execution
                    self._asked_s[robot] = self._bench.group.time_s() + THINKS_S
                case Looked() if body.fulfilled:
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
            self._bench.world.intervene(Intervention(act=Act.RELEASE))
            self._bench.send(robot, Look(expect="way_clear", within_s=LOOKS_S))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--buildings", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--robots", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=300.0)
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
    touches = 0
    for number, (name, scene) in enumerate(scenes):
        began_s = time.process_time()
        drives = Drives(scene, arguments.first + number)
        drives.run(arguments.seconds)
        pace = arguments.seconds / (time.process_time() - began_s)
        print(
            f"{name}: {drives.touches} touches, {_told(drives.counts)}; {pace:.1f} x real time",
            flush=True,
        )
        total += drives.counts
        touches += drives.touches
    print(f"all {len(scenes)}: {touches} touches, {_told(total)}")
    return 1 if touches else 0


def _told(counts: Counter[str]) -> str:
    return ", ".join(f"{count} {what}" for what, count in sorted(counts.items()))


if __name__ == "__main__":
    sys.exit(main())
