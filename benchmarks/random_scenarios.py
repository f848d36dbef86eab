"""Random scenarios: does every run end, and is what it says at the end true?

    python benchmarks/random_scenarios.py [--runs 1000] [--world tabletop|workcell] [--seed 0]
        [--robots 1|2|3] [--person] [--leaves N] [--jobs 2] [--quick] [--replay SEED]

Half of the runs are random trees over random scenes, the others random trees with OR over made-up
scenes (tabletop) or over the EKET base (workcell); with random interventions, and helpers that
answer at random, never, or always yes. Every run's events are audited; its end and every sentence
of its dialogues are compared with its events and with where the simulated world's parts really are.
The exit code is 1 if any run broke a constraint, hung or told an untruth, or if one with a willing
helper did not finish.
With `--robots 2` every run is about a random scene with a second robot across the table, with 3
another one at its end: then no two robots may ever touch, be it with what they hold, and on
the tabletop none may leave the space that it has. With
`--person` somebody does leaves themselves, gives some back and forgets others. With `--leaves` no
run has more of them than that. `--replay` prints one run's events. Tables of up to 60 parts are
worked off here only; the tests take six runs of up to 12.
"""

# ruff: noqa: T201

import argparse
import asyncio
import faulthandler
import json
import logging
import os
import random
import sys
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import nullcontext
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal
from uuid import UUID

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

import numpy as np
from broken_constraints import broken_constraints
from dialogue_judge import DialogueJudge
from leaf_taker import LeafTaker
from outside_their_space import outside_their_space
from random_task import random_nesting, random_task
from touching_robots import touching_robots
from untruths import Rest, find_untruths, kinds_of
from watched_world import WatchedWorld, where_parts_rest

from mend.server.journal import events as ev
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView
from mend.server.settings import Settings
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scenario import Person
from mend.tasks.scene import Base, Scene
from mend.tasks.scene_problem import SceneProblem

if TYPE_CHECKING:
    from mend.server.composition import Service

Answers = Literal["random", "unreliable", "none", "willing"]

KINDS: tuple[Answers, ...] = ("random", "unreliable", "none", "willing")
"""Who helps: somebody who answers at random, the same who keeps promises badly, nobody, and
somebody who always says yes and does it."""

MOST_LEAVES = {"tabletop": 60, "workcell": 12}
MOST_PARTS = {"tabletop": 30, "workcell": 12}
QUIET_S = {"tabletop": 120.0, "workcell": 300.0}
"""Wall seconds without an event after which a run counts as hung, on however busy a machine."""

MOST_EVENTS = 50_000
"""A run with more events than this goes round in circles."""

FORGOTTEN_S = 5.0
"""What people take and forget is anybody's again after that; meanwhile clocks run as theirs do."""

UNRELIABLE = Person(late=0.2, wrong_object=0.15, wrong_place=0.15, never=0.15)
MOST_ASKS = 2000

THREAD_LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one run; every list has one sentence per thing that is wrong."""

    seed: int
    answers: Answers
    leaves: int
    status: RunStatus | Literal["hung"]
    reason: str
    wall_s: float
    simulated_s: float
    missing: int = 0
    taken: int = 0
    violations: list[str] = field(default_factory=list)
    untruths: list[str] = field(default_factory=list)

    @property
    def wrong(self) -> list[str]:
        """Everything that must not be."""
        wrong = [*self.violations, *self.untruths]
        if self.status not in (RunStatus.FINISHED, RunStatus.FAILED):
            wrong.append(f"the run is {self.status}")
        elif self.answers == "willing" and self.status is not RunStatus.FINISHED:
            wrong.append(f"a willing helper could not make it finish: {self.reason}")
        return wrong


# --- One run -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Drawn:
    """A task file, how many leaves its tree has, and its scene's file if it brings one."""

    tree: str
    leaves: int
    scene: str | None = None


def draw(world: str, seed: int, most_leaves: int, robots: int = 1) -> Drawn:
    """What the run of a seed is about."""
    rng = np.random.default_rng(seed)
    if robots > 1 or seed // len(KINDS) % 2:
        return _random_scene(world, seed, min(most_leaves, MOST_PARTS[world]), robots)
    if world == "workcell":
        return _possible_base(rng)
    leaves = int(rng.integers(1, most_leaves + 1))
    return Drawn(json.dumps(random_task(rng, leaves)), leaves)


def _random_scene(world: str, seed: int, most_parts: int, robots: int) -> Drawn:
    """A scene that the world's robot can do, and a tree that places all its parts."""
    from mend.sim.random_scene import random_scene, scene_document
    from mend.sim.world import SceneChecker
    from mend.tasks.plugins import load_plugins

    adapter = load_plugins("mend.worlds")[world]
    assert isinstance(adapter, SceneChecker)

    def check(scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]) -> list[SceneProblem]:
        return adapter.check_scene(_shared(scene, robots) if robots > 1 else scene, nodes)

    parts = int(np.random.default_rng(seed).integers(1, most_parts + 1))
    drawn = random_scene(seed, parts, check)
    tree = {**drawn.tree, "name": "random", "scene": "random"}
    scene = {**scene_document(drawn.scene), "name": "random"}
    if robots > 1:
        bases = _shared(drawn.scene, robots).robots
        scene["robots"] = {name: base.model_dump() for name, base in bases.items()}
    return Drawn(json.dumps(tree), parts, json.dumps(scene))


def _shared(scene: Scene, robots: int) -> Scene:
    """The scene with a second robot across the table from the first, and a third at its end."""
    x, y = scene.table.center
    end_m = y + scene.table.size[1] / 2 + x - scene.table.size[0] / 2
    bases = {
        "here": Base(x=0.0, y=0.0),
        "across": Base(x=2 * x, y=2 * y, yaw=np.pi),
        "end": Base(x=x, y=end_m, yaw=-np.pi / 2),
    }
    return scene.model_copy(update={"robots": dict(list(bases.items())[:robots])})


def _possible_base(rng: np.random.Generator) -> Drawn:
    """A random tree over the EKET base in an order in which there is room for the fingers."""
    from mend.server.behaviors import behavior_parameters
    from mend.sim.workcell.adapter import adapter
    from mend.tasks.scene_file import built_in_scene
    from mend.tasks.task_file import check_task_text

    scene = built_in_scene("eket")
    while True:
        tree, leaves = _random_base(rng)
        task = check_task_text(tree, behavior_parameters(), built_in_scene)
        nodes = [each for each in task.definition.nodes if isinstance(each, BehaviorNode)]
        if not adapter.check_scene(scene, nodes):
            return Drawn(tree, leaves)


def _random_base(rng: np.random.Generator) -> tuple[str, int]:
    """Legs and bars of the EKET base in any nesting; a top only where both legs carry it."""
    frame = [_leaf(each) for each in rng.permutation(["green_leg", "blue_leg"])]
    bars = [_leaf(each) for each in rng.permutation(["pink_bar", "yellow_bar"])]
    bars = bars[: int(rng.integers(0, 3))]
    tops = [_leaf(each) for each in rng.permutation(["purple_top", "orange_top"])]
    tops = tops[: int(rng.integers(0, 3))]
    if not tops:
        parts = _shuffled(rng, [*frame, *bars])
        tree = random_nesting(rng, parts)
        return json.dumps({"name": "random_base", "scene": "eket", "tree": tree}), len(parts)
    below = [random_nesting(rng, frame, ("then", "and"))]
    if bars:
        below.append(random_nesting(rng, bars))
    stages = [{"and" if rng.random() < 0.5 else "then": _shuffled(rng, below)}, {"or": tops}]
    document = {"name": "random_base", "scene": "eket", "tree": {"then": stages}}
    return json.dumps(document), len(frame) + len(bars) + len(tops)


def _shuffled(rng: np.random.Generator, nodes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [nodes[int(index)] for index in rng.permutation(len(nodes))]


def _leaf(part: str) -> dict[str, Any]:
    return {"behavior": "pick_and_place", "object": str(part), "place": str(part)}


def request(world: str, seed: int, answers: Answers) -> RunRequest:
    """A run with random interventions and the given kind of help."""
    said: Any = {"willing": ["yes"] * MOST_ASKS, "none": "none"}.get(answers, "random")
    return RunRequest(
        tree="random",
        world=world,
        speed="max",
        seed=seed,
        answers=said,
        interventions="random",
        person=UNRELIABLE if answers == "unreliable" else Person(),
    )


async def run_once(
    world: str,
    seed: int,
    *,
    robots: int = 1,
    person: bool = False,
    most_leaves: int | None = None,
    show: bool = False,
) -> Outcome:
    """One random scenario on a service of its own, judged."""
    # Only here, so that a worker's limits on threads come before the libraries that heed them.
    from given_documents import given_documents

    from mend.server.composition import open_service

    answers = KINDS[seed % len(KINDS)]
    drawn = draw(world, seed, most_leaves or MOST_LEAVES[world], robots)
    scenes = {} if drawn.scene is None else {"random": drawn.scene}
    given = given_documents({"random": drawn.tree}, scenes)
    settings = Settings(
        port=0,
        journal=Path(IN_MEMORY),
        log_level="error",
        speech_voice="none",
        person_leaf_s=FORGOTTEN_S,
    )
    began = time.perf_counter()
    with (
        touching_robots() if robots > 1 else nullcontext([]) as touched,
        outside_their_space() if robots > 1 else nullcontext([]) as outside,
    ):
        async with open_service(settings, given=given) as service:
            watched = WatchedWorld(service.journal)
            run = (await service.runtime.start_run(request(world, seed, answers))).id
            taker = LeafTaker(service, run, random.Random(seed))
            accompanied = asyncio.create_task(taker.accompany()) if person else None
            view = await _ended_or_hung(service, run, QUIET_S[world])
            if accompanied is not None:
                accompanied.cancel()
            wall_s = time.perf_counter() - began
            events = await service.journal.read(0, 1_000_000, run)
            snapshot = await service.journal.world(run)
    if show:
        _print_events(events)
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    return Outcome(
        seed=seed,
        answers=answers,
        leaves=drawn.leaves,
        status=view.status if view.status.ended else "hung",
        reason=view.result.reason if view.result else "",
        wall_s=wall_s,
        simulated_s=view.time,
        taken=taker.taken,
        missing=len(view.result.missing) if view.result else 0,
        violations=[*broken_constraints(events, kinds_of(started)), *touched[:3], *outside[:3]],
        untruths=_untruths(events, watched, where_parts_rest(started, snapshot))
        if view.status.ended
        else [],
    )


def _untruths(
    events: Sequence[ev.Event], watched: WatchedWorld, resting: Mapping[str, Rest | None]
) -> list[str]:
    """What was said in dialogues, told of them, or at the end, and was not so."""
    said = DialogueJudge(events, watched.moments(events)).judge()
    return [
        *(f"event {each.seq}: '{each.what}': {each.why}" for each in said),
        *find_untruths(events, resting),
    ]


def _print_events(events: Iterable[ev.Event]) -> None:
    shown = ("node", "name", "issue", "step", "text", "answer", "resolution", "reason", "act")
    shown += ("object", "ok", "detail", "at", "help", "failed_attempt", "missing", "by")
    for event in events:
        fields = event.model_dump(mode="json")
        told = " ".join(
            f"{key}={fields[key]}" for key in shown if fields.get(key) not in (None, "")
        )
        print(f"{event.seq:5} {event.time:8.2f} {fields['type']:18} {told}")


# --- Many runs ---------------------------------------------------------------------------------


async def _ended_or_hung(service: "Service", run: UUID, quiet_s: float) -> RunView:
    """The run as it is when it has ended, or when it does not seem to end any more."""
    ended = asyncio.create_task(service.runtime.wait_for_end(run))
    head = -1
    while not ended.done() and head < service.journal.head < MOST_EVENTS:
        head = service.journal.head
        await asyncio.wait({ended}, timeout=quiet_s)
    if ended.done():
        return ended.result()
    ended.cancel()
    return await service.runtime.run(run)


def _work(world: str, seed: int, robots: int, person: bool, most_leaves: int | None) -> Outcome:
    """One run in a worker; a run that blocks its process for good takes the process with it."""
    logging.basicConfig(level=logging.ERROR)
    faulthandler.dump_traceback_later(20 * QUIET_S[world], exit=True)
    try:
        return asyncio.run(
            run_once(world, seed, robots=robots, person=person, most_leaves=most_leaves)
        )
    except Exception as error:
        # Not every error can be sent to the process that waits; one that cannot breaks the pool.
        raise RuntimeError(f"seed {seed}: {type(error).__name__}: {error}") from None
    finally:
        faulthandler.cancel_dump_traceback_later()


def run_all(
    world: str,
    seeds: list[int],
    jobs: int,
    robots: int = 1,
    *,
    person: bool = False,
    most_leaves: int | None = None,
) -> Iterator[Outcome]:
    """The outcomes of all runs as they come in."""
    for name in THREAD_LIMITS:
        os.environ[name] = "1"
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        futures = {
            pool.submit(_work, world, seed, robots, person, most_leaves): seed for seed in seeds
        }
        for future in as_completed(futures):
            try:
                yield future.result()
            except BrokenProcessPool:
                seed = futures[future]
                yield Outcome(seed, KINDS[seed % len(KINDS)], 0, "hung", "", 0.0, 0.0)


def print_table(outcomes: list[Outcome]) -> None:
    """What came of the runs, for each kind of help."""
    heads = ("answers", "runs", "finished", "failed", "hung", "violations", "untruths", "missing")
    print("".join(f"{head:>12}" for head in heads))
    for kind in (*KINDS, "all"):
        some = [each for each in outcomes if kind in (each.answers, "all")]
        count = Counter(str(each.status) for each in some)
        figures = (
            len(some),
            count["finished"],
            count["failed"],
            len(some) - count["finished"] - count["failed"],
            sum(len(each.violations) for each in some),
            sum(len(each.untruths) for each in some),
            sum(each.missing for each in some),
        )
        print(f"{kind:>12}" + "".join(f"{each:>12}" for each in figures))
    reasons = Counter(
        "a leaf could not be done" if "could not be done" in each.reason else each.reason
        for each in outcomes
        if each.status is RunStatus.FAILED
    )
    for reason, count_of in reasons.most_common():
        print(f"failed {count_of} times: {reason}")
    if taken := sum(each.taken for each in outcomes):
        print(f"people took {taken} leaves themselves")
    walls = np.array([each.wall_s for each in outcomes])
    simulated_s = sum(each.simulated_s for each in outcomes)
    print(
        f"wall seconds of a run: median {np.median(walls):.2f}, p95 {np.percentile(walls, 95):.2f},"
        f" most {walls.max():.2f}; simulated {simulated_s / walls.sum():.0f} x real time"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, help="how many (1,000 in tabletop, 50 in workcell)")
    parser.add_argument("--world", choices=sorted(MOST_LEAVES), default="tabletop")
    parser.add_argument("--seed", type=int, default=0, help="the first run's seed")
    parser.add_argument("--robots", type=int, choices=(1, 2, 3), default=1)
    parser.add_argument("--person", action="store_true", help="somebody does leaves themselves")
    parser.add_argument("--leaves", type=int, help="at most, of one run")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="a few runs, as a smoke test")
    parser.add_argument("--replay", type=int, metavar="SEED", help="print one run's events")
    arguments = parser.parse_args()
    if arguments.replay is not None:
        outcome = asyncio.run(
            run_once(
                arguments.world,
                arguments.replay,
                robots=arguments.robots,
                person=arguments.person,
                most_leaves=arguments.leaves,
                show=True,
            )
        )
        print(outcome)
        return 1 if outcome.wrong else 0
    runs = arguments.runs or (1000 if arguments.world == "tabletop" else 50)
    if arguments.quick:
        runs = 8 if arguments.world == "tabletop" else 2
    began = time.perf_counter()
    outcomes: list[Outcome] = []
    seeds = list(range(arguments.seed, arguments.seed + runs))
    for outcome in run_all(
        arguments.world,
        seeds,
        arguments.jobs,
        arguments.robots,
        person=arguments.person,
        most_leaves=arguments.leaves,
    ):
        outcomes.append(outcome)
        for sentence in outcome.wrong:
            print(f"seed {outcome.seed} ({outcome.answers}): {sentence}", flush=True)
        if sys.stdout.isatty():
            print(f"\r{len(outcomes)}/{runs}", end="\r", flush=True)
    print_table(outcomes)
    print(f"{runs} runs in {time.perf_counter() - began:.0f} s")
    return 1 if any(each.wrong for each in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
