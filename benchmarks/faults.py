"""False alarms in clean picks, and how fast faults are noticed, in the workcell.

    python benchmarks/faults.py [--picks 1000] [--faults 200] [--quick]

Pictures have noise, light and exposure change. Beside the robot's own watch, which expects the
object where the tool point is, a plain one looks at the same pictures: it expects the blob where
it was in the image when the gripper closed. Latencies are simulated time from when the fault began;
"out" is from when the fingers really held the object no more. A pull that the fingers withstand for
longer than the limit, or until the object is let down, is counted apart.
"""

# ruff: noqa: T201

import argparse
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import inf
from pathlib import Path

import numpy as np
import yaml

import tasks
from robots.catalogue import Catalogue
from robots.link.messages import Finished, Holding, IssueDetected, ReportBody, Start
from robots.robot import Robot
from robots.senses import Senses
from robots.vision.color_model import ColorModel
from robots.vision.forearm import GripReading, GripState
from sim.workcell.colors import learn_colors
from sim.workcell.options import WorkcellOptions
from sim.workcell.world import WorkcellWorld
from tasks.intervention import Act, Intervention
from tasks.plugins import load_plugins
from tasks.scene import Scene

LIMITS_MS = {"vanish": 150.0, "pull": 800.0, "drop": 300.0, "stolen before": float("nan")}
EXPECTED = {"vanish": "dropped", "pull": "dropped", "drop": "dropped", "stolen before": "missed"}
LONGEST_PICK_S = 60.0


class PlainWatch:
    """The naive way: the blob's centre stays within a fixed range of the image."""

    RANGE_PX = 8.0

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._center: np.ndarray | None = None
        self._outside = 0
        self.alarm_s: float | None = None

    def update(self, reading: GripReading) -> None:
        if reading.state is GripState.UNDECIDED:
            return
        seen = None if reading.blob is None else np.array(reading.blob.center)
        if self._center is None:
            self._center = seen
        inside = (
            seen is not None
            and self._center is not None
            and bool(np.abs(seen - self._center).max() <= self.RANGE_PX)
        )
        self._outside = 0 if inside else self._outside + 1
        if self._outside >= 2 and self.alarm_s is None:
            self.alarm_s = reading.image.time


class SharedSenses(Senses):
    """The robot's senses, whose forearm pictures the plain watch sees too."""

    plain: PlainWatch

    def read_grip(self) -> GripReading | None:
        reading = super().read_grip()
        if reading is not None:
            self.plain.update(reading)
        return reading


@dataclass(slots=True)
class Pick:
    """What became of one pick."""

    name: str
    kind: str
    issues: list[str] = field(default_factory=list)
    fault_s: float | None = None
    out_s: float | None = None
    issue_s: float | None = None
    plain_s: float | None = None
    finished: bool = False
    truly_held: bool = False

    @property
    def caught(self) -> bool:
        return self.issue_s is not None and self.fault_s is not None

    @property
    def withstood(self) -> bool:
        """Whether the fingers held on to the object for as long as a pull may stay unnoticed."""
        if self.kind != "pull" or self.fault_s is None:
            return False
        limit_s = LIMITS_MS[self.kind] / 1e3
        moments = [each for each in (self.out_s, self.issue_s) if each is not None]
        return min(moments, default=inf) - self.fault_s > limit_s

    @property
    def classified(self) -> bool:
        return self.issues[:1] == [EXPECTED[self.kind]]

    @property
    def latency_ms(self) -> float:
        return 1e3 * ((self.issue_s or 0.0) - (self.fault_s or 0.0))


class Bench:
    """A workcell with a robot, driven cycle by cycle so that faults come at exact moments."""

    def __init__(self, scene: Scene, model: ColorModel, seed: int, noise: float, light: float):
        options = WorkcellOptions(renderer="fast", camera_noise=noise, light=light)
        self.world = WorkcellWorld(scene, seed, options)
        catalogue = Catalogue.from_scene(scene)
        senses = SharedSenses(self.world.body, model, catalogue)
        senses.plain = self.plain = PlainWatch()
        self.robot = Robot(
            "r1",
            self.world.body,
            model,
            catalogue,
            load_plugins("mend.behaviors"),
            load_plugins("mend.monitors"),
            senses=senses,
        )
        self._reports: list[tuple[ReportBody, float]] = []
        self.robot.attach(lambda body, time_s, _: self._reports.append((body, time_s)), _ignore)

    def pick(self, pick: Pick, when: tuple[int, float], fault: Callable[[], None] | None) -> Pick:
        """One pick and place, with `fault` at that step and fraction."""
        self._reports.clear()
        self.plain.reset()
        parameters = {"object": pick.name, "place": pick.name}
        start = Start(
            execution=pick.name, node="/0", behavior="pick_and_place", parameters=parameters
        )
        self.robot.handle(pick.name, start)
        begin_s = self.robot.time_s()
        while self.robot.advance(self.world.body.control_period_s):
            progress = self.robot.task_progress
            due = progress is not None and (progress.step, progress.fraction) >= when
            if due and fault is not None and pick.fault_s is None:
                fault()
                pick.fault_s = self.robot.time_s()
            self._note(pick)
            watched = progress is not None and progress.step <= 5
            if watched and pick.fault_s is not None:
                # Fingers that only lose touch for a moment have not lost what they hold.
                gone = self.world.held != pick.name
                pick.out_s = (pick.out_s or self.robot.time_s()) if gone else None
            if self.robot.time_s() > begin_s + LONGEST_PICK_S:
                break
        self._note(pick)
        pick.plain_s = self.plain.alarm_s
        return pick

    def _note(self, pick: Pick) -> None:
        for body, time_s in self._reports:
            match body:
                case IssueDetected() if body.interrupts:
                    pick.issues.append(body.issue)
                    pick.issue_s = pick.issue_s or time_s
                    pick.truly_held = self.world.held == pick.name
                case Finished():
                    pick.finished = True
                case Holding():
                    pass
        self._reports.clear()


def _ignore(_picture: object) -> None:
    """Nobody asked for pictures."""


def orders(rng: np.random.Generator) -> list[str]:
    """The EKET base in one of the orders that its task tree allows."""
    bars = ["pink_bar", "yellow_bar"] if rng.random() < 0.5 else ["yellow_bar", "pink_bar"]
    return ["green_leg", *bars, "blue_leg", str(rng.choice(["purple_top", "orange_top"]))]


def clean_picks(make: Callable[[int], Bench], count: int, seed: int) -> list[Pick]:
    """Whole builds without any fault."""
    rng = np.random.default_rng(seed)
    picks: list[Pick] = []
    while len(picks) < count:
        bench = make(seed + len(picks))
        for name in orders(rng)[: count - len(picks)]:
            picks.append(bench.pick(Pick(name, "clean"), (9, 0.0), None))
            if not picks[-1].finished:
                break
        bench.world.close()
    return picks


def faulty_picks(make: Callable[[int], Bench], count: int, seed: int) -> list[Pick]:
    """Builds in which every part meets a fault first, is put back, and is then placed."""
    rng = np.random.default_rng(seed)
    kinds = list(EXPECTED)
    picks: list[Pick] = []
    while len(picks) < count:
        bench = make(seed + len(picks))
        for name in orders(rng):
            if len(picks) == count:
                break
            kind = kinds[len(picks) % len(kinds)]
            when = (2, float(rng.uniform(0.1, 0.95)))
            if kind != "stolen before":
                when = (int(rng.choice([4, 5])), float(rng.uniform(0.05, 0.9)))
            picks.append(bench.pick(Pick(name, kind), when, fault_of(kind, name, bench)))
            bench.world.intervene(Intervention(act=Act.PUT_BACK, object=name))
            if not bench.pick(Pick(name, "clean"), (9, 0.0), None).finished:
                break
        bench.world.close()
    return picks


def fault_of(kind: str, name: str, bench: Bench) -> Callable[[], None]:
    """What a fault does to the world."""
    if kind == "drop":
        return bench.world.body.open_gripper
    manner = "pull" if kind == "pull" else "vanish"
    steal = Intervention.model_validate({"act": Act.STEAL, "object": name, "manner": manner})

    def act() -> None:
        reason = bench.world.intervene(steal)
        if reason:
            raise RuntimeError(f"{name} could not be stolen: {reason}")

    return act


def report_clean(picks: Sequence[Pick], wall_s: float) -> None:
    alarms = [each for each in picks if each.issues]
    false = [each for each in alarms if set(each.issues) - {"missed", "dropped"} or each.truly_held]
    plain = sum(each.plain_s is not None for each in picks)
    print(f"clean picks {len(picks)}, finished {sum(each.finished for each in picks)}")
    print(f"  alarms {len(alarms)}, of them false (the gripper did hold it) {len(false)}")
    for each in alarms:
        print(f"    {each.name}: {each.issues}, held {each.truly_held}")
    print(f"  plain watch: false alarms {plain}; ratio {plain / max(len(false), 1):.0f}")
    print(f"  ({wall_s:.0f} s)")


def report_faults(picks: Sequence[Pick], wall_s: float) -> None:
    print(f"faults {len(picks)}")
    print(
        f"  {'kind':14}{'n':>4}{'caught':>8}{'right':>7}{'p50 ms':>8}{'p90 ms':>8}{'max ms':>8}"
        f"{'limit':>7}{'out p50':>8}{'out max':>8}{'withstood':>10}{'plain caught':>13}"
        f"{'plain early':>12}"
    )
    for kind in EXPECTED:
        of_kind = [each for each in picks if each.kind == kind and each.fault_s is not None]
        group = [each for each in of_kind if not each.withstood]
        latencies = [each.latency_ms for each in group if each.caught]
        p50, p90, worst = np.percentile(latencies or [np.nan], [50, 90, 100])
        after_ms = [1e3 * (e.issue_s - e.out_s) for e in group if e.issue_s and e.out_s]
        out_p50, out_max = np.percentile(after_ms or [np.nan], [50, 100])
        early = sum(_early(each) for each in group)
        plain = sum(each.plain_s is not None for each in group) - early
        print(
            f"  {kind:14}{len(group):4}{sum(each.caught for each in group):8}"
            f"{sum(each.classified for each in group):7}{p50:8.0f}{p90:8.0f}{worst:8.0f}"
            f"{LIMITS_MS[kind]:7.0f}{out_p50:8.0f}{out_max:8.0f}{len(of_kind) - len(group):10}"
            f"{plain:13}{early:12}"
        )
    for each in picks:
        if each.fault_s is None or not each.caught or not each.classified:
            print(f"    {each.kind} {each.name}: {each.issues or 'no issue'} fault {each.fault_s}")
    print(f"  ({wall_s:.0f} s)")


def _early(pick: Pick) -> bool:
    """Whether the plain watch was alarmed before anything had happened."""
    return pick.plain_s is not None and pick.fault_s is not None and pick.plain_s < pick.fault_s


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picks", type=int, default=1000)
    parser.add_argument("--faults", type=int, default=200)
    parser.add_argument("--noise", type=float, default=4.0, help="grey levels of 255")
    parser.add_argument("--light", type=float, default=1.0, help="how much light varies, 0 to 1")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="10 picks and 8 faults")
    given = parser.parse_args()
    picks, faults = (10, 8) if given.quick else (given.picks, given.faults)
    text = (Path(next(iter(tasks.__path__))) / "scenes" / "eket.yaml").read_text(encoding="utf-8")
    scene = Scene.model_validate_json(json.dumps(yaml.safe_load(text)))
    model = learn_colors(scene, given.noise)

    def make(seed: int) -> Bench:
        return Bench(scene, model, seed, given.noise, given.light)

    print(f"camera noise {given.noise:g} grey levels, light varies by {given.light:g}")
    begin = time.perf_counter()
    clean = clean_picks(make, picks, given.seed)
    report_clean(clean, time.perf_counter() - begin)
    begin = time.perf_counter()
    report_faults(faulty_picks(make, faults, given.seed + 100_000), time.perf_counter() - begin)


if __name__ == "__main__":
    main()
