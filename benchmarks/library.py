"""The shipped tasks, each in every world over many seeds, with nobody there: a promise kept?

    python benchmarks/library.py [--world tabletop] [--task eket] [--seeds 20] [--first-seed 0]
                                 [--noise] [--jobs 2]

Every run is a whole service with a journal. A part is at its place if the world, of which the
robot knows nothing, has it or an equal one there; errors are distances in the plane. `asked` counts
issues, but for the help at the place that a scene says a part needs.
"""

# ruff: noqa: T201

import argparse
import asyncio
import math
import os
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from untruths import Rest
from watched_world import where_parts_rest

from mend.server.journal import events as ev
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.tasks.definition import TaskTreeDefinition
from mend.tasks.library import TREES
from mend.tasks.scenario import Scenario
from mend.tasks.scene import Scene

WORLDS = ("tabletop", "workcell")
NOISY = {"camera_noise": 3.0, "light": 1.0, "depth_noise": 1.0}
OTHER_SCENE = "given"
THERE_M = 0.02
"""A part that is farther from its place than this is somewhere else."""
UPRIGHT_RAD = 0.2
THREAD_LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one run: what was asked, and where the parts of all done leaves are."""

    task: str
    world: str
    seed: int
    finished: bool
    reason: str = ""
    issues: Sequence[str] = ()
    errors_mm: Sequence[float] = ()
    misplaced: Sequence[str] = ()
    moved: int = 0
    wall_s: float = 0.0

    @property
    def kept(self) -> bool:
        """Whether the task was done without help, and really."""
        return self.finished and not self.issues and not self.misplaced


@dataclass(slots=True)
class Tally:
    """All outcomes of one task in one world."""

    outcomes: list[Outcome] = field(default_factory=list)

    def line(self) -> str:
        count = len(self.outcomes)
        errors = sorted(error for each in self.outcomes for error in each.errors_mm)
        told = "-"
        if errors:
            p95 = errors[min(len(errors) - 1, math.ceil(0.95 * len(errors)) - 1)]
            told = f"p95 {p95:.2f} max {errors[-1]:.2f}"
        return (
            f"finished {sum(each.finished for each in self.outcomes)}/{count}  "
            f"asked {sum(len(each.issues) for each in self.outcomes)}  "
            f"misplaced {sum(len(each.misplaced) for each in self.outcomes)}  "
            f"placed {len(errors)}, mm {told}  "
            f"{sum(each.wall_s for each in self.outcomes) / max(count, 1):.1f} s a run"
        )


async def run_task(
    task: str,
    world: str,
    seed: int,
    options: dict[str, float] | None = None,
    scene: Scene | None = None,
    scenario: Scenario | None = None,
) -> Outcome:
    """One run of a shipped task with nobody there to help, in its own scene or in another one.

    `scenario`: what people do there all the same.
    """
    # Only here, so that a worker's limits on threads come before the libraries that heed them.
    from given_documents import given_documents

    from mend.server.composition import open_service

    settings = Settings(port=0, journal=Path(IN_MEMORY), log_level="error", speech_voice="none")
    request = RunRequest(
        tree=task,
        world=world,
        seed=seed,
        speed="max",
        answers="none",
        world_options=options or {},
        scene=None if scene is None else OTHER_SCENE,
        scenario=None if scenario is None else scenario.name,
    )
    begin = time.perf_counter()
    scenes = {} if scene is None else {OTHER_SCENE: scene.model_dump_json()}
    async with open_service(settings, given=given_documents({}, scenes)) as service:
        if scenario is not None:
            await service.library.scenarios.save(scenario.name, scenario.model_dump_json())
        run = (await service.runtime.start_run(request)).id
        view = await service.runtime.wait_for_end(run)
        events = await service.journal.read(0, 1_000_000, run)
        snapshot = await service.journal.world(run)
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    errors_mm, misplaced = compare(started, events, snapshot)
    return Outcome(
        task,
        world,
        seed,
        view.status is RunStatus.FINISHED,
        view.result.reason if view.result else "",
        [
            f"{each.issue} {each.object} in step {each.step}"
            for each in events
            if isinstance(each, ev.IssueRaised) and each.issue != "positioning"
        ],
        errors_mm,
        misplaced,
        len({each.node for each in events if isinstance(each, ev.StepStarted)}),
        time.perf_counter() - begin,
    )


def compare(
    started: ev.RunStarted, events: Sequence[ev.Event], snapshot: dict[str, Any] | None
) -> tuple[list[float], list[str]]:
    """How far the parts of all done leaves are from their places, in mm, and which are not there.

    Of equal parts any may be at the place of another.
    """
    scene = Scene.model_validate(started.scene, strict=False)
    tree = TaskTreeDefinition.model_validate(started.tree)
    leaves = {each.name: each for each in tree.nodes if each.kind == "behavior"}
    rests = where_parts_rest(started, snapshot)
    errors_mm: list[float] = []
    misplaced: list[str] = []
    for event in events:
        if not isinstance(event, ev.NodeDone) or event.name not in leaves:
            continue
        leaf = leaves[event.name]
        assert leaf.object is not None, "every leaf of the library handles an object"
        assert leaf.place is not None, "every leaf of the library fills a place"
        alike = [name for name in scene.objects if _alike(scene, name, leaf.object)]
        error_m = min(_error_m(scene, rests[name], leaf.place) for name in alike)
        if error_m > THERE_M:
            misplaced.append(f"{leaf.object} is not at its place")
        else:
            errors_mm.append(1e3 * error_m)
    return errors_mm, misplaced


def _alike(scene: Scene, one: str, other: str) -> bool:
    first, second = scene.objects[one], scene.objects[other]
    return (first.size, first.knob, first.color) == (second.size, second.knob, second.color)


def _error_m(scene: Scene, rest: Rest | None, place: str) -> float:
    """The distance in the plane; infinite at another height, lying, or for what is gone."""
    if rest is None or rest.lean_rad > UPRIGHT_RAD:
        return math.inf
    pose = scene.places[place].pose
    height_m = scene.table.height if pose.z is None else pose.z
    if abs(rest.z - height_m) > THERE_M:
        return math.inf
    return math.hypot(rest.x - pose.x, rest.y - pose.y)


def _work(task: str, world: str, seed: int, options: dict[str, float]) -> Outcome:
    try:
        return asyncio.run(run_task(task, world, seed, options))
    except Exception as error:
        return Outcome(task, world, seed, False, f"{type(error).__name__}: {error}")


def run_all(
    jobs_of: Sequence[tuple[str, str, int]], options: dict[str, float], jobs: int
) -> Iterator[Outcome]:
    """Every run in a process of a pool, as they end."""
    for name in THREAD_LIMITS:
        os.environ[name] = "1"
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        futures = [pool.submit(_work, *each, options) for each in jobs_of]
        for future in as_completed(futures):
            yield future.result()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--world", choices=WORLDS, help="only this one")
    parser.add_argument("--task", choices=TREES.names(), help="only this one")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--noise", action="store_true", help="noise in colour and depth, light")
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    worlds = [given.world] if given.world else list(WORLDS)
    tasks = [given.task] if given.task else TREES.names()
    seeds = range(given.first_seed, given.first_seed + given.seeds)
    wanted = [(task, world, seed) for world in worlds for task in tasks for seed in seeds]
    tallies = {(world, task): Tally() for task, world, _ in wanted}
    for outcome in run_all(wanted, NOISY if given.noise else {}, given.jobs):
        tallies[outcome.world, outcome.task].outcomes.append(outcome)
        if not outcome.kept:
            told = [*outcome.issues, *outcome.misplaced, outcome.reason]
            print(f"  {outcome.world} {outcome.task} seed {outcome.seed}: {'; '.join(told)}")
    for (world, task), tally in tallies.items():
        print(f"{world:10} {task:12} {tally.line()}")
    kept = all(each.kept for tally in tallies.values() for each in tally.outcomes)
    raise SystemExit(0 if kept else 1)


if __name__ == "__main__":
    main()
