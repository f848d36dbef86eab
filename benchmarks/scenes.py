"""Random scenes and shipped tasks in the workcell, nobody interfering: alarms, what is placed.

    python benchmarks/scenes.py [--scenes 500] [--seed 0] [--parts MOST] [--jobs 2] [--quick]
    python benchmarks/scenes.py --task eket --scenes 100
    python benchmarks/scenes.py --replay SEED
    python benchmarks/scenes.py --scenes 50 --seed 900 --keep some.jsonl
    python benchmarks/scenes.py --show some.jsonl more.jsonl

Pictures and depth have noise, light and exposure change. Leaves are done in an order that the tree
allows, nearest first; a leaf whose attempt ends in an issue is tried again, at most three times, by
the robot alone. An alarm is false if the simulated world, of which the robot knows nothing, does
not bear it out. Errors are distances in the plane between where parts are at the end and their
places; parts that look alike may stand at one another's places.
"""

# ruff: noqa: T201

import argparse
import json
import math
import os
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, field
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mend.robots.link.messages import (
    Finished,
    Interrupt,
    IssueDetected,
    Location,
    Look,
    Looked,
    Rejected,
    ReportBody,
    Start,
)
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.potential import leaf_potentials
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem
from mend.tasks.task_tree import TaskTree

if TYPE_CHECKING:
    from mend.sim.shared_world import SharedWorld

NOISY = {"camera_noise": 3.0, "light": 1.0, "depth_noise": 1.0}
ATTEMPTS = 3
LONGEST_ATTEMPT_S = 180.0
THREAD_LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
THERE_M = 0.02

GOALS = {"placed": 0.99, "false alarms per 1,000": 1.0, "p95 mm": 1.5, "max mm": 3.0}


@dataclass(frozen=True, slots=True)
class Alarm:
    """One issue: of which leaf, in which step, what the robot said, whether it was so."""

    seed: int
    name: str
    issue: str
    step: int
    explanation: str
    true: bool


@dataclass(slots=True)
class Outcome:
    """What came of one scene."""

    seed: int
    parts: int
    attempts: int = 0
    placed: int = 0
    first_try: int = 0
    alarms: list[Alarm] = field(default_factory=list)
    errors_mm: list[float] = field(default_factory=list)
    yaw_deg: list[float] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)
    simulated_s: float = 0.0
    cpu_s: float = 0.0


class Cell:
    """A workcell with its robot, and the judge who knows where things really are."""

    def __init__(self, scene: Scene, seed: int, options: dict[str, Any]) -> None:
        from mend.sim.workcell.adapter import adapter
        from mend.sim.world import WorldSetup

        setup = WorldSetup(robots=["r1"], scene=scene, seed=seed, speed=None, options=options)
        self.scene = scene
        self.group: SharedWorld = adapter.create_agents(setup)
        self.world: Any = self.group.world
        self.reports: list[ReportBody] = []
        self.borne_out: list[tuple[IssueDetected, bool]] = []
        self.task = ("", "")
        self.group.agents[0].attach(self._take, lambda _: None)
        self._commands = 0
        self._alike = {
            name: frozenset(other for other, each in scene.objects.items() if _alike(part, each))
            for name, part in scene.objects.items()
        }

    def _take(self, body: ReportBody, _time_s: float, _world: dict[str, Any] | None) -> None:
        """Note a report; an issue is judged at once, before the arm moves on."""
        self.reports.append(body)
        if isinstance(body, IssueDetected) and body.interrupts:
            self.borne_out.append((body, self._bears_out(body)))

    def command(self, body: Any) -> list[ReportBody]:
        """Have something done to its end, or until an issue; what was reported meanwhile."""
        self._commands += 1
        self.reports.clear()
        self.borne_out.clear()
        self.group.agents[0].handle(f"c{self._commands}", body)
        end_s = self.group.time_s() + LONGEST_ATTEMPT_S
        while self.group.advance(1.0) and self.group.time_s() < end_s:
            pass
        return list(self.reports)

    def look(self) -> Looked:
        return next(each for each in self.command(Look()) if isinstance(each, Looked))

    def _bears_out(self, issue: IssueDetected) -> bool:
        """Whether an issue is true, as far as the world alone can tell."""
        name, place = self.task
        match issue.issue:
            case "missed" | "dropped":
                return not self._holds(name)
            case "missing":
                return bool(self.world.parts[name].stolen)
            case "unreachable":
                return any(
                    self.world.parts[each].pose().tilt_rad > 0.2 for each in self._alike[name]
                )
            case "undone":
                return min(self.distance_m(each, place) for each in self._alike[name]) > THERE_M
            case _:
                return False

    def _holds(self, name: str) -> bool:
        """Whether the fingers are around such a part, and do not only touch it."""
        part = self.scene.objects[name]
        width_m = min((part.knob or part.size)[:2])
        around = self.world.body.gripper_opening_m() > width_m / 2
        return around and self.world.held in self._alike[name]

    def distance_m(self, name: str, place: str) -> float:
        """How far a part is from a place; infinite if it is not at its height."""
        pose, at = self.world.parts[name].pose(), self.scene.places[place].pose
        height_m = self.scene.table.height if at.z is None else at.z
        x, y, z = pose.position
        if abs(z - height_m) > THERE_M or pose.tilt_rad > 0.2:
            return math.inf
        return math.hypot(x - at.x, y - at.y)

    def yaw_error_deg(self, name: str, place: str) -> float:
        period = math.pi / 2 if _square(self.scene, name) else math.pi
        turn = self.world.parts[name].pose().yaw - self.scene.places[place].pose.yaw
        return abs(math.degrees(math.remainder(turn, period)))

    def standing_at(self, name: str, place: str) -> str:
        """The part of a look that is nearest to a place."""
        return min(self._alike[name], key=lambda each: self.distance_m(each, place))


def _alike(one: Any, other: Any) -> bool:
    return (one.size, one.knob, one.color) == (other.size, other.knob, other.color)


def _square(scene: Scene, name: str) -> bool:
    length, width, _ = scene.objects[name].size
    return abs(length - width) < 1e-6


def play(scene: Scene, definition: TaskTreeDefinition, seed: int, *, show: bool = False) -> Outcome:
    """Do a whole task in a scene."""
    begin = time.process_time()
    cell = Cell(scene, seed, NOISY)
    tree = TaskTree(definition)
    tree.running = True
    outcome = Outcome(seed, 0)
    failed: set[int] = set()
    while (leaf := _next_leaf(tree, cell, failed)) is not None:
        attempt(tree, leaf, cell, outcome, failed, show=show)
    judge(tree, cell, outcome)
    outcome.simulated_s = cell.group.time_s()
    cell.world.close()
    outcome.cpu_s = time.process_time() - begin
    return outcome


def _next_leaf(tree: TaskTree, cell: Cell, failed: set[int]) -> int | None:
    leaves = tree.eligible_leaves()
    able = np.array([int(each) not in failed for each in leaves], dtype=np.bool_)
    if not able.any():
        return None
    looked = cell.look()
    seen = {name: (each.x, each.y, each.z) for name, each in looked.objects.items()}
    hand = (looked.gripper.x, looked.gripper.y, looked.gripper.z)
    potentials = leaf_potentials(tree.nodes, leaves, seen, hand, np.ones(leaves.size))
    return tree.choose(leaves, potentials, able)


def attempt(
    tree: TaskTree, leaf: int, cell: Cell, outcome: Outcome, failed: set[int], *, show: bool
) -> None:
    """One attempt at a leaf."""
    definition = tree.leaf_definition(leaf)
    name, place = _object_and_place(tree, leaf)
    tree.start(leaf, "r1")
    cell.task = (name, place)
    outcome.attempts += 1
    reports = cell.command(
        Start(
            execution=f"e{outcome.attempts}",
            node=tree.path_of(leaf),
            behavior=definition.behavior,
            parameters={**definition.parameters, "needs_help": False},
            target=Location(**cell.scene.places[place].pose.model_dump()),
        )
    )
    issues = list(cell.borne_out)
    for issue, true in issues:
        explanation = issue.detection.explanation if issue.detection else ""
        alarm = Alarm(outcome.seed, name, issue.issue, issue.step, explanation, true)
        outcome.alarms.append(alarm)
        if show:
            print(f"{cell.group.time_s():7.1f} {alarm}")
    if not issues and any(isinstance(each, Finished) for each in reports):
        outcome.first_try += tree.attempts(leaf) == 0
        tree.finish(leaf)
        if show:
            where = cell.standing_at(name, place)
            print(
                f"{cell.group.time_s():7.1f} {name}: {1e3 * cell.distance_m(where, place):.2f} mm"
            )
        return
    refused = [each.reason for each in reports if isinstance(each, Rejected)]
    outcome.wrong += [f"seed {outcome.seed}, {name}: rejected: {each}" for each in refused]
    tree.put_back(leaf, failed=True)
    if tree.attempts(leaf) >= ATTEMPTS:
        failed.add(leaf)
    cell.command(Interrupt(retreat=True))


def judge(tree: TaskTree, cell: Cell, outcome: Outcome) -> None:
    """Measure where the parts of all leaves that are done really are."""
    done = [leaf for leaf in tree.leaves if tree.done(leaf)]
    outcome.parts = len(done) if tree.done(0) else len(tree.leaves)
    for leaf in done:
        name, place = _object_and_place(tree, leaf)
        part = cell.standing_at(name, place)
        error_mm = 1e3 * cell.distance_m(part, place)
        if error_mm > 1e3 * THERE_M:
            what = f"seed {outcome.seed}, {name}: done, but not at its place"
            outcome.wrong.append(f"{what} ({error_mm:.1f} mm)")
            continue
        outcome.placed += 1
        outcome.errors_mm.append(error_mm)
        outcome.yaw_deg.append(cell.yaw_error_deg(part, place))


def _object_and_place(tree: TaskTree, leaf: int) -> tuple[str, str]:
    definition = tree.leaf_definition(leaf)
    assert definition.object is not None, "every leaf of these tasks handles an object"
    assert definition.place is not None, "every leaf of these tasks fills a place"
    return definition.object, definition.place


def run(seed: int, task: str | None, most_parts: int, *, show: bool = False) -> Outcome:
    """One scene in a process of its own."""
    from mend.server.behaviors import behavior_parameters
    from mend.tasks.task_file import check_task_text

    if task is not None:
        from mend.tasks.library import TREES
        from mend.tasks.scene_file import built_in_scene

        definition = check_task_text(
            TREES.read(task), behavior_parameters(), built_in_scene
        ).definition
        assert definition.scene is not None
        return play(built_in_scene(definition.scene), definition, seed, show=show)
    from mend.sim.random_scene import random_scene

    drawn = random_scene(seed, int(np.random.default_rng(seed).integers(1, most_parts + 1)), _check)
    text = json.dumps(drawn.tree)
    definition = check_task_text(text, behavior_parameters(), lambda _: drawn.scene).definition
    return play(drawn.scene, definition, seed, show=show)


def _check(scene: Scene, leaves: Sequence[BehaviorNode]) -> list[SceneProblem]:
    from mend.sim.workcell.adapter import adapter
    from mend.sim.world import SceneChecker

    return adapter.check_scene(scene, leaves) if isinstance(adapter, SceneChecker) else []


def run_all(
    seeds: Sequence[int], task: str | None, most_parts: int, jobs: int
) -> Iterator[Outcome]:
    for name in THREAD_LIMITS:
        os.environ[name] = "1"
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        futures = {pool.submit(run, seed, task, most_parts): seed for seed in seeds}
        for future in as_completed(futures):
            try:
                yield future.result()
            except Exception as error:
                seed = futures[future]
                yield Outcome(seed, 0, wrong=[f"seed {seed}: {type(error).__name__}: {error}"])


def read(path: Path) -> Iterator[Outcome]:
    """The outcomes that an earlier run kept."""
    for line in path.read_text(encoding="utf-8").splitlines():
        raw = json.loads(line)
        raw["alarms"] = [Alarm(**each) for each in raw["alarms"]]
        yield Outcome(**raw)


def report(outcomes: Sequence[Outcome], wall_s: float) -> bool:
    """Print what came of all; True if every goal is met."""
    parts = sum(each.parts for each in outcomes)
    picks = sum(each.attempts for each in outcomes)
    placed = sum(each.placed for each in outcomes)
    alarms = [alarm for each in outcomes for alarm in each.alarms]
    false = [each for each in alarms if not each.true]
    errors = [error for each in outcomes for error in each.errors_mm]
    yaws = [yaw for each in outcomes for yaw in each.yaw_deg]
    wrong = [sentence for each in outcomes for sentence in each.wrong]
    for alarm in alarms:
        kind = "true " if alarm.true else "FALSE"
        print(
            f"  {kind} seed {alarm.seed} {alarm.name}: {alarm.issue} in step {alarm.step} "
            f"({alarm.explanation})"
        )
    for sentence in wrong:
        print(f"  {sentence}")
    whole = sum(each.placed == each.parts > 0 for each in outcomes)
    first = sum(each.first_try for each in outcomes)
    print(
        f"{len(outcomes)} scenes, {parts} parts, {picks} attempts; placed {placed} "
        f"({placed / max(parts, 1):.2%}), at the first try {first} ({first / max(parts, 1):.2%}), "
        f"whole scenes {whole}"
    )
    by_kind = Counter((each.issue, each.true) for each in alarms)
    per_thousand = 1e3 * len(false) / max(picks, 1)
    kinds = [f"{'' if true else 'false '}{kind} {n}" for (kind, true), n in by_kind.items()]
    print(
        f"alarms {len(alarms)}, false {len(false)} ({per_thousand:.1f} per 1,000 attempts): "
        + ", ".join(kinds)
    )
    figures = {
        "placed": placed / max(parts, 1),
        "false alarms per 1,000": per_thousand,
    }
    if errors:
        p50, p95, most = np.percentile(errors, [50, 95, 100])
        print(
            f"placed, mm in the plane: p50 {p50:.2f}, p95 {p95:.2f}, max {most:.2f}; "
            f"yaw, degrees: p95 {np.percentile(yaws, 95):.2f}, max {max(yaws):.2f}"
        )
        figures |= {"p95 mm": p95, "max mm": most}
    simulated_s = sum(each.simulated_s for each in outcomes)
    cpu_s = sum(each.cpu_s for each in outcomes)
    print(f"{simulated_s / max(cpu_s, 1e-9):.1f} x real time; {wall_s:.0f} s")
    met = [
        figures[name] >= goal if name == "placed" else figures[name] <= goal
        for name, goal in GOALS.items()
        if name in figures
    ]
    return all(met) and not wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0, help="of the first scene")
    parser.add_argument("--parts", type=int, default=30, help="most parts of a scene")
    parser.add_argument("--task", help="a task of the library instead of random scenes")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="two scenes of at most six parts")
    parser.add_argument("--replay", type=int, metavar="SEED", help="one scene, told as it goes")
    parser.add_argument("--keep", type=Path, help="add what comes of each scene to this file")
    parser.add_argument("--show", type=Path, nargs="+", help="report what was kept in these")
    given = parser.parse_args()
    if given.show:
        return 0 if report([each for path in given.show for each in read(path)], 0.0) else 1
    if given.replay is not None:
        return 0 if report([run(given.replay, given.task, given.parts, show=True)], 0.0) else 1
    scenes, parts = (2, 6) if given.quick else (given.scenes, given.parts)
    begin = time.perf_counter()
    outcomes = []
    for outcome in run_all(range(given.seed, given.seed + scenes), given.task, parts, given.jobs):
        outcomes.append(outcome)
        print(f"\r{len(outcomes)}/{scenes}", end="", flush=True)
        if given.keep:
            with given.keep.open("a", encoding="utf-8") as file:
                print(json.dumps(asdict(outcome)), file=file)
    print("\r", end="")
    return 0 if report(outcomes, time.perf_counter() - begin) else 1


if __name__ == "__main__":
    raise SystemExit(main())
