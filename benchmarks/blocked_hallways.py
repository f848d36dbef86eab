"""Robots that drive in buildings with blocked hallways: what do they ask, how long do they take?

    python benchmarks/blocked_hallways.py [--first 0] [--buildings 5] [--rooms 40] [--robots 2]
        [--drives 5] [--blocked 0.1] [--answer 60] [--ask]

Draws buildings of one floor by seeds; people block a share of the lanes along their hallways. Each
robot drives to rooms that are drawn, the same whatever it does. Whoever is asked makes way after a
time that is drawn (exponential, its mean is `--answer`), and the robot looks whether that is so.
What one robot finds the others are told, as a fleet does. With `--ask` robots know of no way round,
and ask about everything that bars their way.
"""

# ruff: noqa: T201
import argparse
import math
import sys
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from building_bench import BuildingBench, made_up

from mend.robots.base.base import Base
from mend.robots.base.body import BasePose
from mend.robots.base.closed_ways import KEPT_S
from mend.robots.link.messages import (
    Avoid,
    ClosedWay,
    Detection,
    Finished,
    IssueDetected,
    Look,
    Looked,
    Resume,
    WayFound,
)
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention

SLICE_S = 0.25
LOOKS_S = 1e5
LONGEST_S = 3600.0
"""After so long a building is left."""


def _know_one_way() -> None:
    """Have bases remember nothing of what bars their way, so that they know of no way round."""

    def bar(_: Base, __: tuple[str, str]) -> None:
        """Nothing is remembered."""

    def round_takes_s(_: Base, __: BasePose) -> float:
        return math.inf

    Base.bar, Base.round_takes_s = bar, round_takes_s  # type: ignore[method-assign]


class Drives:
    """The robots of one building, and who is asked there."""

    def __init__(self, seed: int, options: argparse.Namespace) -> None:
        self._rng = np.random.default_rng([seed, 2])
        building = made_up(1, options.rooms, seed)
        scene = scene_of(building, "office", options.robots)
        self.bench = BuildingBench(scene, seed=seed, blocked_hallways=options.blocked)
        rooms = sorted(each for each in scene.places if each.startswith("F1-1"))
        self._goals = {
            robot: [rooms[n] for n in self._rng.permutation(len(rooms))[: options.drives]]
            for robot in scene.robots
        }
        self._answer_s = options.answer
        self._shares = not options.ask
        self._began_s: dict[str, float] = {}
        self._makes_way_s: dict[str, float] = {}
        self._held: dict[str, str] = {}
        self._closed: dict[frozenset[str], float] = {}
        self._read = 0
        self.took_s: list[float] = []
        self.counts: Counter[str] = Counter()

    def run(self) -> None:
        """Until every robot is through with its drives."""
        for robot in self._goals:
            self._send_on(robot)
        while self._began_s and self.bench.group.time_s() < LONGEST_S:
            self.bench.group.advance(SLICE_S)
            self._hear()
            self._make_way()
        self.counts["not arrived"] += len(self._began_s)

    def _send_on(self, robot: str) -> None:
        self._began_s.pop(robot, None)
        if self._goals[robot]:
            self._began_s[robot] = self.bench.group.time_s()
            self.bench.go(robot, self._goals[robot].pop())

    def _hear(self) -> None:
        new, self._read = self.bench.reports[self._read :], len(self.bench.reports)
        for robot, body in new:
            match body:
                case Finished():
                    self.took_s.append(self.bench.group.time_s() - self._began_s[robot])
                    self._send_on(robot)
                case IssueDetected():
                    self._asked(robot, body)
                case Looked(fulfilled=True):
                    self._makes_way_s.pop(robot, None)
                    self.counts["led round while it asked"] += body.led_round
                    self.bench.send(robot, Resume(execution=self._held[robot]))
                case WayFound():
                    self.counts[f"found {body.finding}"] += 1
                    self._share(body.finding, body.between)

    def _asked(self, robot: str, issue: IssueDetected) -> None:
        self.counts[f"asked: {issue.issue}"] += 1
        self._held[robot] = issue.execution
        after_s = float(self._rng.exponential(self._answer_s))
        self._makes_way_s[robot] = self.bench.group.time_s() + after_s
        seen = issue.detection or Detection(camera="")
        if len(seen.between) == 2:
            self._share(issue.issue, seen.between)
        self.bench.send(robot, Look(expect="way_clear", within_s=LOOKS_S))

    def _share(self, finding: str, between: list[str]) -> None:
        if not self._shares:
            return
        self._closed.pop(frozenset(between), None)
        if finding != "open":
            self._closed[frozenset(between)] = self.bench.group.time_s() + KEPT_S
        ways = [ClosedWay(between=sorted(way), until=s) for way, s in self._closed.items()]
        for each in self._goals:
            self.bench.send(each, Avoid(ways=ways))

    def _make_way(self) -> None:
        now_s = self.bench.group.time_s()
        due = [robot for robot, due_s in self._makes_way_s.items() if due_s <= now_s]
        for robot in due:
            self._makes_way_s[robot] = now_s + 10.0
            self.bench.world.intervene(Intervention(act=Act.RELEASE))


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--buildings", type=int, default=5)
    parser.add_argument("--rooms", type=int, default=40)
    parser.add_argument("--robots", type=int, default=2)
    parser.add_argument("--drives", type=int, default=5)
    parser.add_argument("--blocked", type=float, default=0.1)
    parser.add_argument("--answer", type=float, default=60.0)
    parser.add_argument("--ask", action="store_true")
    options = parser.parse_args()
    if options.ask:
        _know_one_way()
    counts, took_s, touches = Counter[str](), list[float](), 0
    for seed in range(options.first, options.first + options.buildings):
        drives = Drives(seed, options)
        drives.run()
        counts += drives.counts
        took_s += drives.took_s
        touches += drives.bench.world.touches
        median, most = np.median(drives.took_s), max(drives.took_s)
        print(
            f"{seed}: {len(drives.took_s)} drives, median {median:.0f} s, most {most:.0f} s; "
            f"{dict(drives.counts)}",
            flush=True,
        )
    mean, p50, p90 = np.mean(took_s), *np.percentile(took_s, [50, 90])
    print(
        f"{len(took_s)} drives: {mean:.0f} s in the mean, {p50:.0f} (p50), {p90:.0f} (p90), "
        f"{max(took_s):.0f} (most); {dict(sorted(counts.items()))}; {touches} cycles in touch"
    )


if __name__ == "__main__":
    main()
