"""Carried robots: do they say that they are lost, and how far do they drive until they are not?

Each robot drives for a while over a floor map among furniture and people that are on no map, is
then put down elsewhere on the floor, at least 4 m away, with its odometry saying that it stood
still, and drives on. It has recovered once its estimate is within 1 m and 30 degrees, it does not
say that it is lost, and both stay so. The particle filters have no recovery; they stand beside it
for what they say. At the end it is told, by tenths of the probability of being lost, in how many
updates that was told and how often the robot was off then (by more than 1 m or 30 degrees).

    python benchmarks/localization_kidnapped.py [--maps FOLDER] [--map GHC4 ...] [--trials 50]
        [--explained 0.6] [--people 1] [--first-seed 1] [--method enml ...] [--rough] [--quick]

`--rough` drives with the second laser (`synthetic/rough_laser.py`), with which nothing was set.
"""

# ruff: noqa: T201
import argparse
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from synthetic.floors import floor_maps
from synthetic.rough_laser import RoughLaser
from synthetic.settings import SceneSettings
from synthetic.world import Scene, scene

from mend.localization.evaluation import is_off
from mend.localization.localizer import Localizer
from mend.localization.logs.log import LogStep
from mend.localization.methods import METHODS, warm_up
from mend.localization.pose import Poses
from mend.maps.vector_map import VectorMap

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data"))
STEP_M = 0.1
DRIVE_M = 60.0
BEFORE, AFTER = 50, 80
CARRIED_M = 4.0
WITHIN_M = 5.0
TRIALS_PER_DRIVE = 3
REMOVED = 0.02


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one carried robot; metres since it was put down, None for never."""

    said_m: float | None
    recovered_m: float | None
    silent_m: float
    """How far it drove while it was wrong and did not say that it was lost."""
    longest_ms: float
    told: list[tuple[float, bool]] = field(default_factory=list, repr=False)
    """The probability of being lost after each update, and whether the robot was off."""


def legs(made_up: Scene, generator: np.random.Generator) -> tuple[list[LogStep], list[LogStep]]:
    """A stretch of a drive, and one that begins elsewhere with no motion told."""
    steps = made_up.log.steps
    while True:
        left = int(generator.integers(BEFORE, len(steps)))
        put = int(generator.integers(0, len(steps) - AFTER))
        way = made_up.truth[put, :2] - made_up.truth[left - 1, :2]
        if np.hypot(*way) >= CARRIED_M:
            break
    before, after = list(steps[left - BEFORE : left]), list(steps[put : put + AFTER])
    last_s = before[-1].scan.time_s
    begins_s = after[0].scan.time_s
    moved = [
        replace(each, scan=replace(each.scan, time_s=last_s + 1.0 + each.scan.time_s - begins_s))
        for each in after
    ]
    for leg in (before, moved):
        leg[0] = replace(leg[0], odometry=np.zeros(3))
    return before, moved


def reference_of(step: LogStep) -> Poses:
    """Where the robot is; a made-up drive knows it."""
    assert step.reference is not None
    return step.reference


def carry(localizer: Localizer, before: list[LogStep], after: list[LogStep]) -> Outcome:
    """Drive, be carried, drive on."""
    localizer.reset(reference_of(before[0]))
    told = []
    for step in before:
        estimate = localizer.update(step.odometry, step.scan)
        told.append((estimate.lost, is_off(estimate.pose, reference_of(step))))
    said_m = recovered_m = None
    silent = 0
    longest_s = 0.0
    for index, step in enumerate(after):
        began_s = time.process_time()
        estimate = localizer.update(step.odometry, step.scan)
        longest_s = max(longest_s, time.process_time() - began_s)
        off = is_off(estimate.pose, reference_of(step))
        told.append((estimate.lost, off))
        if estimate.is_lost and said_m is None:
            said_m = index * STEP_M
        if off or estimate.is_lost:
            recovered_m = None
        elif recovered_m is None:
            recovered_m = index * STEP_M
        silent += off and not estimate.is_lost
    return Outcome(said_m, recovered_m, silent * STEP_M, 1e3 * longest_s, told)


def trials(
    vector_maps: dict[str, VectorMap], settings: SceneSettings, count: int, first_seed: int
) -> Iterator[tuple[str, int, Scene, np.random.Generator]]:
    """So many, the maps in turn, a new drive every few trials."""
    names = list(vector_maps)
    made_up: dict[str, Scene] = {}
    for number in range(count):
        name = names[number % len(names)]
        lap = number // len(names)
        seed = first_seed + lap // TRIALS_PER_DRIVE
        if lap % TRIALS_PER_DRIVE == 0:
            made_up[name] = scene(vector_maps[name], settings, seed)
        yield name, seed, made_up[name], np.random.default_rng([first_seed, number])


def told(method: str, outcomes: list[Outcome]) -> str:
    """One line."""
    back = [each.recovered_m for each in outcomes if each.recovered_m is not None]
    soon = sum(each <= WITHIN_M for each in back)
    said = [each.said_m for each in outcomes if each.said_m is not None]
    silent = [each.silent_m for each in outcomes]
    recovered = f", median {np.median(back):.1f} m" if back else ""
    told_it = f", after {np.median(said):.1f} m in the median" if said else ""
    return (
        f"{method:5s} recovered within {WITHIN_M:g} m: {soon} of {len(outcomes)} "
        f"({soon / len(outcomes):.0%}){recovered}; said that it was lost: "
        f"{len(said)}{told_it}; wrong and silent: median {np.median(silent):.1f} m, more than "
        f"1 m in {sum(each > 1.0 for each in silent)}; longest update "
        f"{max(each.longest_ms for each in outcomes):.0f} ms of processor time"
    )


def calibrated(outcomes: list[Outcome]) -> str:
    """One line: by tenths of the probability how many updates there were, and how many off."""
    told = np.array([each for outcome in outcomes for each in outcome.told], dtype=float)
    tenths = np.minimum((10.0 * told[:, 0]).astype(int), 9)
    rows = [told[tenths == tenth, 1] for tenth in range(10)]
    return "      lost by tenths: " + ", ".join(
        f"{tenth / 10:.1f} {int(off.sum())}/{len(off)}" for tenth, off in enumerate(rows)
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--maps", type=Path, default=DATA / "localization/maps")
    parser.add_argument("--map", action="append", help="only this one; may be repeated")
    parser.add_argument("--trials", type=int, default=50)
    parser.add_argument("--explained", type=float, default=0.6)
    parser.add_argument("--people", type=float, default=1.0)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--method", action="append", choices=list(METHODS))
    parser.add_argument("--rough", action="store_true", help="the second laser")
    parser.add_argument("--quick", action="store_true", help="4 trials")
    given = parser.parse_args()
    methods = given.method or list(METHODS)
    vector_maps = floor_maps(given.maps, given.map)
    for method in methods:
        warm_up(method)
    changed = given.explained < 1.0
    settings = SceneSettings(
        length_m=DRIVE_M,
        step_m=STEP_M,
        explained=given.explained,
        people=given.people if changed else 0.0,
        removed=REMOVED if changed else 0.0,
        rough=RoughLaser() if given.rough else None,
    )
    outcomes: dict[str, list[Outcome]] = {method: [] for method in methods}
    count = 4 if given.quick else given.trials
    for name, seed, made_up, generator in trials(vector_maps, settings, count, given.first_seed):
        before, after = legs(made_up, generator)
        for method in methods:
            localizer = METHODS[method](vector_maps[name], seed)
            outcome = carry(localizer, before, after)
            outcomes[method].append(outcome)
            print(f"{name} {seed} {method} {outcome}", flush=True)
    print(f"\n{count} robots carried, {given.explained:.0%} explained by the map")
    for method in methods:
        print(told(method, outcomes[method]))
        print(calibrated(outcomes[method]))


if __name__ == "__main__":
    main()
