"""False alarms in clean picks, and how fast faults are noticed, over random scenes in the workcell.

    python benchmarks/faults.py [--picks 1000] [--faults 400] [--seed 1] [--quick]

Parts are drawn over all that the gripper fits, dark, grey and equal ones too. Pictures and depth
have noise, light and exposure change. Beside the robot's own watch a plain one looks at the same
pictures: it expects the blob of the part's colours where it was in the image when the gripper
closed. An alarm in a clean pick is false if the fingers do hold the part. Latencies are simulated
time from when the fault began; "out" is from when the fingers really held the part no more. A pull
that the fingers withstand for longer than the limit, or until the part is let down, is counted
apart. A part that is stolen or swapped before the grasp is judged once the gripper has closed.
"""

# ruff: noqa: T201

import argparse
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any

import numpy as np

from robots.catalogue import Catalogue
from robots.grip import GripReading, GripState
from robots.link.messages import Finished, Interrupt, IssueDetected, Look, Looked, ReportBody, Start
from robots.robot import Robot
from robots.senses import Senses
from sim.random_scene import NoRoomError, random_scene
from sim.workcell.colors import learn_colors
from sim.workcell.options import WorkcellOptions
from sim.workcell.world import WorkcellWorld
from sim.world import SceneChecker
from tasks.definition import BehaviorNode
from tasks.intervention import Act, Intervention
from tasks.plugins import load_plugins
from tasks.scene import Scene
from tasks.scene_problem import SceneProblem

LIMITS_MS = {"vanish": 150.0, "pull": 800.0, "drop": 300.0}
EXPECTED = {
    "vanish": "dropped",
    "pull": "dropped",
    "drop": "dropped",
    "stolen before": "missed",
    "swapped": "missed",
}
WRONG_HAND = "wrong hand-over"
LONGEST_PICK_S = 90.0
HAND_OVER_S = 9.0
MOST_PARTS = 6
CLOSED_M = 0.005
GRIP_ISSUES = {"missed", "dropped"}


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
    """What became of one pick, or of one hand-over."""

    name: str
    kind: str
    seed: int
    issues: list[str] = field(default_factory=list)
    fault_s: float | None = None
    out_s: float | None = None
    issue_s: float | None = None
    plain_s: float | None = None
    finished: bool = False
    truly_held: bool = False
    why: str = ""

    @property
    def caught(self) -> bool:
        return self.issue_s is not None and self.fault_s is not None

    @property
    def false(self) -> bool:
        """Whether it said that it does not hold what it holds."""
        return self.issues[:1] != [] and self.issues[0] in GRIP_ISSUES and self.truly_held

    @property
    def withstood(self) -> bool:
        """Whether the fingers held on to the part for as long as a pull may stay unnoticed."""
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

    def __init__(self, scene: Scene, seed: int, noise: float, light: float) -> None:
        options = WorkcellOptions(renderer="fast", camera_noise=noise, light=light, depth_noise=1.0)
        self.scene, self.seed = scene, seed
        self.world = WorkcellWorld(scene, seed, options)
        model = learn_colors(scene, noise)
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

    def pick(
        self, name: str, kind: str, when: tuple[int, float], fault: Callable[[], None] | None
    ) -> Pick:
        """One pick and place, with `fault` at that step and fraction."""
        pick = Pick(name, kind, self.seed)
        self._reports.clear()
        self.plain.reset()
        parameters = {"object": name, "place": place_of(name)}
        start = Start(execution=name, node="/0", behavior="pick_and_place", parameters=parameters)
        self.robot.handle(name, start)
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
                gone = self.world.held != name
                pick.out_s = (pick.out_s or self.robot.time_s()) if gone else None
            if self.robot.time_s() > begin_s + LONGEST_PICK_S:
                break
        self._note(pick)
        pick.plain_s = self.plain.alarm_s
        return pick

    def take(self, wanted: str, offered: str) -> bool:
        """Whether the robot, told to take `wanted` from a person, takes what is `offered`."""
        self.act(Act.HAND_OVER, offered)
        self._reports.clear()
        look = Look(expect="in_gripper", object=wanted, within_s=HAND_OVER_S)
        self.robot.handle("look", look)
        while self.robot.advance(1.0):
            pass
        return any(isinstance(body, Looked) and body.fulfilled for body, _ in self._reports)

    def act(self, act: Act, name: str, **how: Any) -> None:
        """Do what a person does. Raises `RuntimeError` where that cannot be."""
        given = {"act": act, "object": name, **how}
        reason = self.world.intervene(Intervention.model_validate(given))
        if reason:
            raise RuntimeError(f"{act} {name}: {reason}")

    def swap(self, name: str, other: str) -> None:
        """Another part is where this one was."""
        parts = self.world.parts
        pose = parts[name].pose()
        parts[name].take_away()
        parts[other].put(pose)

    def _holds(self, name: str) -> bool:
        """Whether the part is between the fingers, not only touched by fingers that met."""
        apart = self.world.body.gripper_opening_m() > CLOSED_M
        return apart and self.world.held == name

    def _note(self, pick: Pick) -> None:
        for body, time_s in self._reports:
            match body:
                case IssueDetected() if body.interrupts:
                    if not pick.issues:
                        pick.issue_s, pick.truly_held = time_s, self._holds(pick.name)
                        pick.why = body.detection.explanation if body.detection else ""
                    pick.issues.append(body.issue)
                case Finished():
                    pick.finished = True
        self._reports.clear()


def _ignore(_picture: object) -> None:
    """Nobody asked for pictures."""


def benches(seed: int, noise: float, light: float) -> Iterator[Bench]:
    """Workcells with random scenes, one after the other."""
    for number in range(seed, seed + 1_000_000):
        count = int(np.random.default_rng(number).integers(2, MOST_PARTS + 1))
        try:
            scene = random_scene(number, count, _check).scene
        except NoRoomError:
            continue
        bench = Bench(scene, number, noise, light)
        yield bench
        bench.world.close()


def _check(scene: Scene, leaves: Sequence[BehaviorNode]) -> list[SceneProblem]:
    adapter = load_plugins("mend.worlds")["workcell"]
    return adapter.check_scene(scene, leaves) if isinstance(adapter, SceneChecker) else []


def place_of(name: str) -> str:
    """Where a random scene has a part go."""
    return name.replace("part", "place")


def alone(scene: Scene) -> list[str]:
    """The parts that are on the table, with nothing on them, at their start and at their place."""
    top = scene.table.height + 1e-6
    stacked = [
        each.pose
        for each in (*scene.objects.values(), *scene.places.values())
        if (each.pose.z or 0.0) > top
    ]

    def is_free(x: float, y: float) -> bool:
        return all(np.hypot(x - each.x, y - each.y) > 0.12 for each in stacked)

    return [
        name
        for name, each in scene.objects.items()
        if is_free(each.pose.x, each.pose.y)
        and is_free(scene.places[place_of(name)].pose.x, scene.places[place_of(name)].pose.y)
    ]


def clean_picks(of: Iterator[Bench], count: int) -> list[Pick]:
    """Parts placed without any fault."""
    picks: list[Pick] = []
    for bench in of:
        for name in alone(bench.scene):
            if len(picks) == count:
                return picks
            picks.append(bench.pick(name, "clean", (9, 0.0), None))
    return picks


def faulty_picks(of: Iterator[Bench], count: int, seed: int) -> list[Pick]:
    """Parts that meet a fault first, are put back, and are then placed."""
    rng = np.random.default_rng(seed)
    kinds = [*EXPECTED, WRONG_HAND]
    picks: list[Pick] = []
    for bench in of:
        for name in alone(bench.scene):
            if len(picks) == count:
                return picks
            kind = kinds[len(picks) % len(kinds)]
            pick = _faulty(bench, name, kind, rng)
            if pick is None:
                continue
            picks.append(pick)
            if not _clear_up(bench, name):
                break
    return picks


def _faulty(bench: Bench, name: str, kind: str, rng: np.random.Generator) -> Pick | None:
    """One fault; None where this part cannot have it, or the pick never came so far."""
    other = _unlike(bench, name)
    if kind in ("swapped", WRONG_HAND) and other is None:
        return None
    if kind == WRONG_HAND:
        return _wrong_hand_over(bench, name, str(other))
    when = (2, float(rng.uniform(0.1, 0.9)))
    if EXPECTED[kind] == "dropped":
        when = (int(rng.choice([4, 5])), float(rng.uniform(0.05, 0.9)))
    pick = bench.pick(name, kind, when, _fault_of(kind, name, other, bench))
    return pick if pick.fault_s is not None else None


def _wrong_hand_over(bench: Bench, name: str, other: str) -> Pick:
    pick = Pick(name, WRONG_HAND, bench.seed, fault_s=bench.robot.time_s())
    try:
        took_wrong = bench.take(name, other)
        bench.act(Act.PUT_BACK, other)
        pick.finished = not took_wrong and bench.take(name, name)
    except RuntimeError as error:
        pick.why = str(error)
        return pick
    if not took_wrong:
        pick.issues, pick.issue_s = ["refused"], bench.robot.time_s()
    return pick


def _unlike(bench: Bench, name: str) -> str | None:
    """Another part that a gripper or a camera can tell from this one."""
    mine = bench.scene.objects[name]
    for other in alone(bench.scene):
        its = bench.scene.objects[other]
        same = np.allclose(mine.color, its.color, atol=0.15) and np.allclose(
            sorted(mine.size[:2])[0], sorted(its.size[:2])[0], atol=0.008
        )
        if other != name and not same:
            return other
    return None


def _fault_of(kind: str, name: str, other: str | None, bench: Bench) -> Callable[[], None]:
    """What a fault does to the world."""
    if kind == "drop":
        return bench.world.body.open_gripper
    if kind == "swapped" and other is not None:
        return lambda: bench.swap(name, other)
    manner = "pull" if kind == "pull" else "vanish"
    return lambda: bench.act(Act.STEAL, name, manner=manner)


def _clear_up(bench: Bench, name: str) -> bool:
    """Put everything back to where it started, and let the robot be as at first."""
    bench.robot.handle("end", Interrupt(retreat=True))
    while bench.robot.advance(1.0):
        pass
    try:
        for each in (name, *bench.scene.objects):
            bench.act(Act.PUT_BACK, each)
    except RuntimeError:
        return False
    return True


def report_clean(picks: Sequence[Pick], wall_s: float) -> None:
    false = [each for each in picks if each.false]
    plain = sum(each.plain_s is not None for each in picks)
    issues = Counter(issue for each in picks for issue in each.issues[:1])
    print(f"clean picks {len(picks)}, finished {sum(each.finished for each in picks)}")
    print(f"  first issues: {dict(issues) or 'none'}")
    print(f"  missed or dropped while the fingers did hold it: {len(false)}")
    for each in picks:
        if each.issues:
            print(f"    {each.seed} {each.name}: {each.issues}, held {each.truly_held}; {each.why}")
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
        of_kind = [each for each in picks if each.kind == kind]
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
            f"{LIMITS_MS.get(kind, np.nan):7.0f}{out_p50:8.0f}{out_max:8.0f}"
            f"{len(of_kind) - len(group):10}{plain:13}{early:12}"
        )
    hands = [each for each in picks if each.kind == WRONG_HAND]
    print(
        f"  {WRONG_HAND:14}{len(hands):4}, refused {sum(each.caught for each in hands)}, "
        f"then the right one taken {sum(each.finished for each in hands)}"
    )
    for each in picks:
        wrong = not each.caught or (each.kind in EXPECTED and not each.classified)
        wrong = wrong and not each.withstood
        if wrong or (each.kind == WRONG_HAND and not each.finished):
            said = each.issues or "no issue"
            print(f"    {each.seed} {each.kind} {each.name}: {said} {each.why}")
    print(f"  ({wall_s:.0f} s)")


def _early(pick: Pick) -> bool:
    """Whether the plain watch was alarmed before anything had happened."""
    return pick.plain_s is not None and pick.fault_s is not None and pick.plain_s < pick.fault_s


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picks", type=int, default=1000)
    parser.add_argument("--faults", type=int, default=400)
    parser.add_argument("--noise", type=float, default=4.0, help="grey levels of 255")
    parser.add_argument("--light", type=float, default=1.0, help="how much light varies, 0 to 1")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="10 picks and 12 faults")
    given = parser.parse_args()
    picks, faults = (10, 12) if given.quick else (given.picks, given.faults)
    print(f"camera noise {given.noise:g} grey levels, light varies by {given.light:g}")
    begin = time.perf_counter()
    clean = clean_picks(benches(given.seed, given.noise, given.light), picks)
    report_clean(clean, time.perf_counter() - begin)
    begin = time.perf_counter()
    of = benches(given.seed + 100_000, given.noise, given.light)
    faulty = faulty_picks(of, faults, given.seed)
    report_faults(faulty, time.perf_counter() - begin)


if __name__ == "__main__":
    main()
