"""How long drives through buildings take, in the continuous world and by the model of them.

    python benchmarks/drive_times.py [FILE...] [--drives 100] [--each 10] [--first 1]
        [--localizer exact|enml] [--people 0] [--unmapped 0] [--steps]

One robot drives from place to place of the shipped office and of drawn buildings, `--each` drives
in each, on one floor and across floors; doors are open and elevators come when robots call them.
The world is that of `mend run --world building` (20 Hz, laser, dynamic window, cabins), the model
`sim/building/trips.py` with `fleet/dispatch/cabins.py`, which weeks of discrete events are made of.
With people and furniture the difference is what those cost: who is asked makes way 2 s later.
`--steps` tells each drive and ride of a trip by itself.
"""

# ruff: noqa: T201
import argparse
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from building_bench import BuildingBench, made_up

from mend.fleet.dispatch.cabins import Cabins
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.scheduling.building_travel import travel_in
from mend.maps.building.building import Building, Caller
from mend.maps.building.building_file import read_building_file
from mend.robots.link.messages import (
    Finished,
    Interrupt,
    IssueDetected,
    Look,
    Looked,
    ReportBody,
    Resume,
    StepStarted,
)
from mend.sim.building.scene import scene_name, scene_of
from mend.sim.building.trips import BuildingTrips
from mend.tasks.intervention import Act, Intervention

OFFICE = Path(__file__).parents[1] / "examples" / "buildings" / "office.yaml"
THINKS_S, LOOKS_S, LONGEST_S = 2.0, 60.0, 600.0
WITHIN = 0.05


@dataclass(frozen=True, slots=True)
class Drive:
    """A drive as it was (seconds), by the model, and as a dispatcher plans it.

    `steps` has both of each part.
    """

    what: str
    took_s: float
    model_s: float
    planned_s: float
    metres: float
    rides: int
    steps: Sequence[tuple[str, float, float]]

    @property
    def off(self) -> float:
        """By how much of what it took the model is off."""
        return self.model_s / self.took_s - 1.0


class Timing:
    """Has the robot of one building drive from place to place."""

    def __init__(self, name: str, building: Building, seed: int, options: argparse.Namespace):
        self._name, self._building = name, _called_by_robots(building)
        scene = scene_of(self._building, "drives", 1)
        self._bench = BuildingBench(
            scene,
            seed=seed,
            localizer=options.localizer,
            people=options.people,
            unmapped=options.unmapped,
        )
        self._robot = next(iter(scene.robots))
        self._heard: list[tuple[float, ReportBody]] = []
        self._bench.group.agents[0].attach(
            lambda body, _time, _world: self._heard.append((self._now_s, body)), lambda _: None
        )
        self._trips, self._cabins = BuildingTrips(self._building), Cabins(self._building)
        graph, plain = (
            self._building.graph,
            FleetSetting(robots=(ServiceRobot(name="a", start="a"),)),
        )
        self._planned = travel_in(graph, plain.speed_m_s, starts_s=plain.starts_s)
        self._names = {
            scene_name(place.name): place.name
            for place in self._building.graph.places
            if scene_name(place.name) in scene.places
        }
        self._rng = np.random.default_rng(seed)
        self.issues: Counter[str] = Counter()

    def drives(self, count: int) -> Iterator[Drive]:
        """Drive to so many places; what does not end is left out and counted as an issue."""
        here = self._start()
        for _ in range(count):
            goals = sorted(each for each in self._names if each != here)
            goal = goals[int(self._rng.integers(len(goals)))]
            began_s = self._now_s
            self._heard.clear()
            self._bench.go(self._robot, goal)
            if not self._arrives(began_s + LONGEST_S):
                self.issues["not there"] += 1
                return
            yield self._timed(here, goal, began_s)
            here = goal

    @property
    def _now_s(self) -> float:
        return self._bench.world.time_s()

    def _start(self) -> str:
        base = self._bench.scene.robots[self._robot]
        at = (base.x, base.y, base.z)
        places = self._bench.scene.places
        return next(
            n for n in self._names if (p := places[n].pose) and (p.x, p.y, p.z or 0.0) == at
        )

    def _arrives(self, until_s: float) -> bool:
        """Drive on, helped by somebody, to the end; whether that came."""
        read, asked_s, held = 0, None, ""
        while self._now_s < until_s:
            self._bench.group.advance(0.25)
            new, read = self._heard[read:], len(self._heard)
            for time_s, body in new:
                match body:
                    case Finished():
                        return True
                    case IssueDetected():
                        self.issues[body.issue] += 1
                        asked_s, held = time_s + THINKS_S, body.execution
                    case Looked() if body.fulfilled:
                        self._bench.send(self._robot, Resume(execution=held))
                    case Looked():
                        break
            if asked_s is not None and self._now_s >= asked_s:
                asked_s = None
                self._bench.world.intervene(Intervention(act=Act.RELEASE))
                self._bench.send(self._robot, Look(expect="way_clear", within_s=LOOKS_S))
        self._bench.send(self._robot, Interrupt(retreat=True))
        return False

    def _timed(self, here: str, goal: str, began_s: float) -> Drive:
        trip = self._trips.trip(self._names[here], self._names[goal])
        model: list[float] = []
        for stage in trip:
            model.append(stage.drives_s)
            if stage.ride is not None:
                ride = self._cabins.take(stage.ride, began_s + sum(model))
                model += [ride.waits_s + stage.ride.gets_in_s, ride.rides_s - stage.ride.gets_in_s]
        marks = [(t, each) for t, each in self._heard if isinstance(each, StepStarted | Finished)]
        steps = [
            (a.name, until_s - since_s, predicted)
            for (since_s, a), (until_s, _), predicted in zip(marks, marks[1:], model, strict=False)
            if isinstance(a, StepStarted)
        ]
        metres = sum(each.drives_m for each in trip)
        what = f"{self._name}: {here} to {goal}"
        took_s, planned_s = marks[-1][0] - began_s, self._planned_s(here, goal)
        return Drive(what, took_s, sum(model), planned_s, metres, len(trip) - 1, steps)

    def _planned_s(self, here: str, goal: str) -> float:
        graph = self._building.graph
        ends = graph.index(self._names[here]), graph.index(self._names[goal])
        return float(self._planned.time_s[ends])


def _called_by_robots(building: Building) -> Building:
    """Nobody has to press a button."""
    elevators = {
        name: each.model_copy(update={"called_by": Caller.ROBOTS})
        for name, each in building.document.elevators.items()
    }
    return Building(building.document.model_copy(update={"elevators": elevators}))


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path, default=[OFFICE], metavar="FILE")
    parser.add_argument("--drives", type=int, default=100)
    parser.add_argument("--each", type=int, default=10)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--localizer", choices=["enml", "exact"], default="exact")
    parser.add_argument("--people", type=int, default=0)
    parser.add_argument("--unmapped", type=float, default=0.0)
    parser.add_argument("--steps", action="store_true")
    parser.add_argument("--quick", action="store_true", help="five drives in each of two buildings")
    given = parser.parse_args()
    if given.quick:
        given.drives, given.each = 10, 5
    drives: list[Drive] = []
    issues: Counter[str] = Counter()
    for name, building, seed in _buildings(given.files, given.first):
        if len(drives) >= given.drives:
            break
        timing = Timing(name, building, seed, given)
        for drive in timing.drives(min(given.each, given.drives - len(drives))):
            print(f"{drive.what}: {drive.took_s:.2f} s, model {drive.model_s:.2f} s", end="")
            print(f" ({100 * drive.off:+.1f} %)", flush=True)
            for step, took_s, model_s in drive.steps if given.steps else ():
                print(f"    {step}: {took_s:.2f} s, model {model_s:.2f} s")
            drives.append(drive)
        issues += timing.issues
    for what, some in (
        ("on one floor", [each for each in drives if not each.rides]),
        ("with rides", [each for each in drives if each.rides]),
        ("all", drives),
    ):
        if some:
            _sum_up(what, some)
    print("asked for:", ", ".join(f"{n} {what}" for what, n in issues.items()) or "nothing")


def _buildings(files: Sequence[Path], first: int) -> Iterator[tuple[str, Building, int]]:
    """Those of files, and drawn ones without end."""
    for number, file in enumerate(files):
        yield file.stem, read_building_file(file), first + number
    seed = first
    while True:
        yield f"seed {seed}", made_up(1 + seed % 4, 6 + seed % 15, seed), seed
        seed += 1


def _sum_up(what: str, drives: Sequence[Drive]) -> None:
    off = np.array([each.off for each in drives])
    took_s = sum(each.took_s for each in drives)
    total = sum(each.model_s for each in drives) / took_s - 1.0
    planned_s = np.array([each.planned_s - each.took_s for each in drives])
    late_s = np.array([each.took_s - each.model_s for each in drives])
    print(
        f"{what}: {len(drives)} drives, {sum(e.metres for e in drives):.0f} m, {took_s:.0f} s; off "
        f"by {100 * np.abs(off).mean():.1f} % (mean), {100 * np.percentile(np.abs(off), 95):.1f} % "
        f"(p95), {100 * np.abs(off).max():.1f} % (most); {100 * (np.abs(off) < WITHIN).mean():.0f} "
        f"% within 5 %; the total by {100 * total:+.2f} %; later than the model by "
        f"{late_s.mean():.2f} s (mean), {np.percentile(late_s, 95):.2f} s (p95)"
    )
    print(
        f"    dispatchers plan {planned_s.mean():+.1f} s (mean), off by "
        f"{np.abs(planned_s).mean():.1f} s; the total by {100 * planned_s.sum() / took_s:+.1f} %"
    )


if __name__ == "__main__":
    main()
