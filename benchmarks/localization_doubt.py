"""False doubt: how often does a robot that nobody carried say that it is lost?

Robots drive over floor maps among furniture and people that are on no map; with `--logs` also the
real drives whose maps are there. Every way is cut into stretches of 10 m. A stretch is held where
plain Monte Carlo localization, which never doubts, was never more than 1 m or 30 degrees off in it;
doubt in it is false where `is_lost` was raised over more than 2 m of it. Told are all those, and
how many of them EnML was right in. Somebody puts either method right that was off for 1 m of its
way. Intervals are 95 %, exact (Clopper-Pearson).

    python benchmarks/localization_doubt.py [--maps FOLDER] [--map GHC4 ...] [--kilometres 20]
        [--explained 1 0.6 0.45] [--length 200] [--first-seed 1] [--rough] [--logs] [--quick]
"""

# ruff: noqa: T201
import argparse
import os
from collections import defaultdict
from dataclasses import dataclass
from math import ceil
from pathlib import Path

import numpy as np
from scipy.stats import beta
from synthetic.floors import floor_maps, in_use
from synthetic.world import scene

from mend.localization.evaluation import Trace, follow
from mend.localization.logs.log import RecordedDrive
from mend.localization.logs.reading import read_log
from mend.localization.methods import METHODS, warm_up
from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data"))
STRETCH_M, DOUBT_M = 10.0, 2.0


@dataclass(frozen=True, slots=True)
class Stretches:
    """Whole stretches of some ways; `right`: those of false doubt in which EnML was never off."""

    driven: int = 0
    held: int = 0
    doubted: int = 0
    right: int = 0

    def __add__(self, other: "Stretches") -> "Stretches":
        return Stretches(
            self.driven + other.driven,
            self.held + other.held,
            self.doubted + other.doubted,
            self.right + other.right,
        )

    def __str__(self) -> str:
        low = float(beta.ppf(0.025, self.doubted, self.held - self.doubted + 1))
        high = float(beta.ppf(0.975, self.doubted + 1, max(self.held - self.doubted, 1e-9)))
        thousandths = f"{1e3 * max(low, 0.0) if self.doubted else 0.0:.1f} to {1e3 * high:.1f}"
        return (
            f"{self.driven * STRETCH_M / 1e3:.2f} km, {self.held} stretches held by mcl: "
            f"false doubt in {self.doubted} ({thousandths} in 1,000), right in {self.right} of them"
        )


def stretches(doubting: Trace, holding: Trace) -> Stretches:
    """Of one way, by two methods that followed it."""
    along_m = doubting.along_m
    steps_m, number = np.diff(along_m, prepend=0.0), (along_m // STRETCH_M).astype(int)
    found = Stretches()
    for each in range(number[-1]):
        there = number == each
        held = not holding.off[there].any()
        doubted = held and steps_m[there & doubting.said_lost].sum() > DOUBT_M
        right = doubted and not doubting.off[there].any()
        found += Stretches(1, int(held), int(doubted), int(right))
    return found


def followed(vector_map: VectorMap, log: RecordedDrive, seed: int) -> Stretches:
    """Both methods on one drive."""
    traces = []
    for method in ("enml", "mcl"):
        localizer = METHODS[method](vector_map, seed)
        assert log.start is not None
        localizer.reset(log.start)
        traces.append(follow(localizer, log, intervene=True))
    return stretches(*traces)


def made_up(given: argparse.Namespace) -> None:
    """Drives over floor maps, the maps and shares in turn."""
    vector_maps = floor_maps(given.maps, given.map)
    each_way = len(vector_maps) * len(given.explained) * given.length
    laps = ceil(1e3 * given.kilometres / each_way)
    totals: dict[float, Stretches] = defaultdict(Stretches)
    for seed in range(given.first_seed, given.first_seed + laps):
        for name, vector_map in vector_maps.items():
            for explained in given.explained:
                settings = in_use(given.length, explained, rough=given.rough)
                drive = scene(vector_map, settings, seed)
                found = followed(vector_map, drive.log, seed)
                totals[explained] += found
                print(f"{name} {seed}, {drive.explained:.0%} explained: {found}", flush=True)
    laser = "the rough laser" if given.rough else "the plain laser"
    for explained, found in totals.items():
        print(f"made-up drives, {laser}, {explained:.0%} explained by the map: {found}")
    print(f"made-up drives, {laser}, all: {sum(totals.values(), Stretches())}", flush=True)


def real(given: argparse.Namespace) -> None:
    """Every log here that has a map and a reference."""
    total = Stretches()
    for path in sorted((given.data / "localization").rglob("*-corrected.log.gz")):
        name = path.name.removesuffix("-corrected.log.gz")
        maps = list((given.data / "localization").rglob(f"{name}.vectormap.txt"))
        if not maps:
            print(f"{name}: no {name}.vectormap.txt, left out")
            continue
        log = read_log(path)
        found = followed(read_vector_map(maps[0]), log, given.first_seed)
        total += found
        print(f"{name}: {found}", flush=True)
    print(f"real drives, all: {total}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--maps", type=Path, default=DATA / "localization/maps")
    parser.add_argument("--map", action="append", help="only this one; may be repeated")
    parser.add_argument("--kilometres", type=float, default=20.0)
    parser.add_argument("--explained", type=float, nargs="+", default=[1.0, 0.6, 0.45])
    parser.add_argument("--length", type=float, default=200.0, help="metres of each drive")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--rough", action="store_true", help="the second laser")
    parser.add_argument("--logs", action="store_true", help="the real drives instead")
    parser.add_argument("--quick", action="store_true", help="one short drive for each share")
    given = parser.parse_args()
    if given.quick:
        given.length, given.map = 30.0, given.map or ["GHC4"]
        given.kilometres = 0.0001
    for method in ("enml", "mcl"):
        warm_up(method)
    if given.logs:
        real(given)
    else:
        made_up(given)


if __name__ == "__main__":
    main()
