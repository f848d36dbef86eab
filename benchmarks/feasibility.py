"""Is what `mend check` says before a run so? Parts beside tall things, in the workcell.

    python benchmarks/feasibility.py [--scenes 100] [--seed 0] [--jobs 2] [--quick]
    python benchmarks/feasibility.py --replay SEED

In each scene one part is to be brought to its place past one to three things that are 100 to 300 mm
high, so near that the arm may or may not get past them. The check is asked, and the robot tries in
any case, as often as `scenes.py` has it. Scenes with plainer mistakes (two things in one spot,
something beyond the table) are drawn anew.
"""

# ruff: noqa: T201

import argparse
import math
import os
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context

import numpy as np
from scenes import THREAD_LIMITS, Outcome, play

from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition
from mend.tasks.scene import Place, Pose, Scene, SceneObject

PART = "part"
NEAR_M, FAR_M = 0.05, 0.25
COLORS = ((0.1, 0.2, 0.9), (0.9, 0.1, 0.1), (0.1, 0.7, 0.2), (0.9, 0.8, 0.1))
LEAF = BehaviorNode(
    parent=0, name=PART, behavior="pick_and_place", parameters={"object": PART, "place": PART}
)
TASK = TaskTreeDefinition(
    name="past_tall_things", nodes=[GoalNode(kind="then", parent=None, name="all"), LEAF]
)
ABOUT_THE_ARM = ("in the arm's way", "the arm would touch", "does not reach", "the arm reaches")
ABOUT_FINGERS = ("for the fingers",)


@dataclass(frozen=True, slots=True)
class Answer:
    """What was said of one scene before, and what came of it."""

    seed: int
    said: tuple[str, ...]
    placed: bool
    alarms: tuple[str, ...]
    check_s: float

    @property
    def kind(self) -> str:
        said = "refused" if self.said else "accepted"
        return f"{said}, {'placed' if self.placed else 'not placed'}"


def draw(rng: np.random.Generator) -> Scene:
    """Something tall beside the start or the place of a part."""
    size = tuple(float(each) for each in rng.uniform((0.02, 0.02, 0.03), (0.05, 0.05, 0.09)))
    start, goal = _spot(rng, -0.45, -0.15), _spot(rng, -0.05, 0.2)
    objects = {PART: SceneObject(color=COLORS[0], size=(size[0], size[1], size[2]), pose=start)}
    for number in range(1, int(rng.integers(2, 5))):
        beside = start if rng.random() < 0.5 else goal
        angle, away_m = rng.uniform(-math.pi, math.pi), rng.uniform(NEAR_M, FAR_M)
        at = Pose(
            x=beside.x + away_m * math.cos(angle),
            y=beside.y + away_m * math.sin(angle),
            yaw=float(rng.uniform(-math.pi, math.pi)),
        )
        across = rng.uniform(0.04, 0.08, 2)
        tall = (float(across[0]), float(across[1]), float(rng.uniform(0.1, 0.3)))
        objects[f"tall_{number}"] = SceneObject(color=COLORS[number], size=tall, pose=at)
    return Scene(name="past_tall_things", objects=objects, places={PART: Place(pose=goal)})


def _spot(rng: np.random.Generator, low_y: float, high_y: float) -> Pose:
    x, y = rng.uniform((0.45, low_y), (0.7, high_y))
    return Pose(x=float(x), y=float(y), yaw=float(rng.uniform(-math.pi, math.pi)))


def scene_of(seed: int) -> tuple[Scene, tuple[str, ...], float]:
    """The first scene drawn that has no plain mistake, what is said of it, and in which time."""
    from mend.sim.workcell.adapter import adapter

    rng = np.random.default_rng(seed)
    while True:
        scene = draw(rng)
        begin = time.perf_counter()
        said = tuple(each.message for each in adapter.check_scene(scene, TASK.nodes))
        if all(any(why in each for why in ABOUT_THE_ARM + ABOUT_FINGERS) for each in said):
            return scene, said, time.perf_counter() - begin


def answer(seed: int, *, show: bool = False) -> Answer:
    scene, said, check_s = scene_of(seed)
    outcome: Outcome = play(scene, TASK, seed, show=show)
    alarms = tuple(f"{each.issue}: {each.explanation}" for each in outcome.alarms)
    return Answer(seed, said, outcome.placed == 1, alarms, check_s)


def answers(seeds: Sequence[int], jobs: int) -> Iterator[Answer]:
    for name in THREAD_LIMITS:
        os.environ[name] = "1"
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        for future in as_completed([pool.submit(answer, seed) for seed in seeds]):
            yield future.result()


def tell(found: Answer) -> None:
    why = "; ".join([*found.said, *found.alarms])
    print(f"seed {found.seed}: {found.kind} ({found.check_s:.1f} s){': ' if why else ''}{why}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="of the first scene")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="two scenes")
    parser.add_argument("--replay", type=int, metavar="SEED")
    options = parser.parse_args()
    if options.replay is not None:
        tell(answer(options.replay, show=True))
        return
    count = 2 if options.quick else options.scenes
    found = []
    for each in answers(range(options.seed, options.seed + count), options.jobs):
        found.append(each)
        tell(each)
    counts = Counter(each.kind for each in found)
    print(f"{len(found)} scenes: " + ", ".join(f"{n} {kind}" for kind, n in counts.items()))
    for said in (False, True):
        times_s = [each.check_s for each in found if bool(each.said) is said]
        if times_s:
            kind = "refused" if said else "accepted"
            print(f"{kind}: checked in {np.median(times_s):.2f} s, at most {max(times_s):.2f} s")


if __name__ == "__main__":
    main()
