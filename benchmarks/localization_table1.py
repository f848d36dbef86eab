"""Distance between interventions per floor map: EnML against CGR and MCL, in made-up drives.

The published comparison (Veloso et al. 2015, Table 1) drove for real; here robots drive over maps
of the same floors among furniture that is on no map, walking people and removed walls. Somebody
intervenes when a robot has been more than 1 m or 30 degrees off for 1 m of its way: it is then
put right. All methods see the same scans and odometry, with their defaults. Intervals are 95 %,
exact for Poisson counts; where nobody had to intervene, ">" stands before the whole distance.

    python benchmarks/localization_table1.py [--maps FOLDER] [--map GHC4 ...] [--explained 0.6 ...]
        [--seeds 20] [--length 100] [--method enml ...] [--rough] [--quick] [--plot FILE.svg]

`--rough` drives with the second laser (`synthetic/rough_laser.py`), with which nothing was set.
"""

# ruff: noqa: T201
import argparse
import os
import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import inf
from pathlib import Path

import numpy as np
from scipy.stats import beta, chi2
from synthetic.floors import floor_maps, in_use
from synthetic.world import Scene, scene

from mend.localization.evaluation import follow
from mend.localization.localizer import Timed
from mend.localization.methods import METHODS, warm_up
from mend.localization.pictures.canvas import Svg
from mend.maps.vector_map import VectorMap

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data"))
PUBLISHED_KM = {
    "GHC4": (0.62, 4.42),
    "GHC6": (8.61, 9.48),
    "GHC7": (5.58, 9.02),
    "GHC8": (6.04, 19.36),
    "GHC9": (5.33, 20.05),
    "NSH4": (0.56, 2.65),
}
"""Kilometres between interventions, CGR and EnML, as published."""
COLORS = {"enml": (140, 30, 170), "cgr": (255, 140, 0), "mcl": (30, 160, 60)}


@dataclass
class Tally:
    """What one method did over some drives."""

    driven_m: float = 0.0
    interventions: int = 0
    errors_m: list[float] = field(default_factory=list)
    errors_deg: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)

    def add(self, other: "Tally") -> None:
        """Take in what another tally holds."""
        self.driven_m += other.driven_m
        self.interventions += other.interventions
        self.errors_m += other.errors_m
        self.errors_deg += other.errors_deg
        self.seconds += other.seconds

    @property
    def between_m(self) -> float:
        """Metres between interventions; the whole distance where there was none."""
        return self.driven_m / max(self.interventions, 1)

    @property
    def interval_m(self) -> tuple[float, float]:
        """Its 95 % confidence interval."""
        count = self.interventions
        most = chi2.ppf(0.975, 2 * count + 2) / 2.0
        least = chi2.ppf(0.025, 2 * count) / 2.0 if count else 0.0
        return self.driven_m / most, self.driven_m / least if least else inf


def ratio(better: Tally, worse: Tally) -> tuple[float, float, float]:
    """How many times farther one drives between interventions, with its 95 % interval.

    With no intervention at all, half of one is counted.
    """
    a, b = better.interventions, worse.interventions
    value = (better.driven_m / max(a, 0.5)) / (worse.driven_m / max(b, 0.5))
    # Given how many there were in all, how many fell to one of the two is binomial.
    low = float(beta.ppf(0.025, b, a + 1)) if b else 0.0
    high = float(beta.ppf(0.975, b + 1, a)) if a else 1.0
    scale = better.driven_m / worse.driven_m
    return (
        value,
        scale * low / (1.0 - low) if low < 1.0 else inf,
        scale * high / (1.0 - high) if high < 1.0 else inf,
    )


def drive(method: str, vector_map: VectorMap, made_up: Scene, seed: int) -> Tally:
    """One drive of one method."""
    localizer = Timed(METHODS[method](vector_map, seed), time.process_time)
    start = made_up.log.start
    assert start is not None
    localizer.reset(start)
    trace = follow(localizer, made_up.log, intervene=True)
    return Tally(
        made_up.log.path_m(),
        len(trace.interventions),
        trace.errors_m.tolist(),
        np.degrees(trace.errors_rad).tolist(),
        trace.durations_s.tolist(),
    )


def told(tally: Tally) -> str:
    """One cell of the table."""
    low, high = tally.interval_m
    more = ">" if not tally.interventions else ""
    upper = "inf" if high == inf else f"{high:.0f}"
    return (
        f"{more}{tally.between_m:.0f} m ({low:.0f}-{upper}; {tally.interventions} in "
        f"{tally.driven_m:.0f} m), {np.median(tally.errors_m) * 100:.1f} cm "
        f"{np.median(tally.errors_deg):.2f} deg"
    )


def told_ratio(better: Tally, worse: Tally) -> str:
    """How much better, with the interval."""
    value, low, high = ratio(better, worse)
    upper = "inf" if high == inf else f"{high:.1f}"
    return f"{value:.2f} ({low:.2f}-{upper})"


def summed(tallies: Iterable[Tally]) -> Tally:
    """All of them in one."""
    total = Tally()
    for each in tallies:
        total.add(each)
    return total


def plot(rows: dict[str, dict[str, Tally]], path: Path) -> None:
    """Bars of metres between interventions on a logarithmic scale, with their intervals."""
    width, height, left, base = 160 + 110 * len(rows), 380, 70.0, 330.0
    svg = Svg(width, height)

    def y(metres: float) -> float:
        return base - 70.0 * float(np.log10(min(max(metres, 1.0), 1e4)))

    for power in range(5):
        svg.segments(np.array([[left, y(10.0**power), width, y(10.0**power)]]), (220, 220, 220))
        svg.text(8, y(10.0**power) + 4, f"{10**power} m")
    for number, (name, tallies) in enumerate(rows.items()):
        x = left + 30 + number * 110
        svg.text(x - 10, base + 20, name)
        for place, (method, tally) in enumerate(tallies.items()):
            at = x + 28 * place
            low, high = tally.interval_m
            bar = np.array([[at, base], [at, y(tally.between_m)]])
            svg.path(bar, COLORS[method], 16)
            svg.segments(np.array([[at, y(low), at, y(high)]]), (20, 20, 20))
    for place, (method, color) in enumerate(COLORS.items()):
        svg.dots(np.array([[left + 90 * place, 20.0]]), color, 6)
        svg.text(left + 12 + 90 * place, 24, method)
    svg.text(left + 300, 24, "metres between interventions, 95 %")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(svg.document(), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--maps", type=Path, default=DATA / "localization/maps")
    parser.add_argument("--map", action="append", help="only this one; may be repeated")
    parser.add_argument("--explained", type=float, nargs="+", default=[0.6, 0.45, 0.3])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--length", type=float, default=100.0, help="metres of each drive")
    parser.add_argument("--method", action="append", choices=list(METHODS))
    parser.add_argument("--rough", action="store_true", help="the second laser")
    parser.add_argument("--quick", action="store_true", help="1 seed, 25 m, 30 %% explained")
    parser.add_argument("--plot", type=Path, default=Path("out/localization_table1.svg"))
    given = parser.parse_args()
    if given.quick:
        given.seeds, given.length, given.explained = 1, 25.0, [0.3]
    methods = given.method or list(METHODS)
    vector_maps = floor_maps(given.maps, given.map)
    for method in methods:
        warm_up(method)
    tallies: dict[tuple[str, float], dict[str, Tally]] = {}
    for name, vector_map in vector_maps.items():
        for explained in given.explained:
            settings = in_use(given.length, explained, rough=given.rough)
            row = tallies[name, explained] = {method: Tally() for method in methods}
            for seed in range(given.first_seed, given.first_seed + given.seeds):
                made_up = scene(vector_map, settings, seed)
                for method in methods:
                    row[method].add(drive(method, vector_map, made_up, seed))
            print(f"\n{name}, {explained:.0%} explained by the map")
            show(row)
    per_map = {
        name: {
            method: summed(tallies[name, each][method] for each in given.explained)
            for method in methods
        }
        for name in vector_maps
    }
    for explained in given.explained:
        print(f"\nall maps, {explained:.0%} explained")
        show({m: summed(tallies[name, explained][m] for name in vector_maps) for m in methods})
    for name, row in per_map.items():
        print(f"\n{name}, all drives", end="")
        if name in PUBLISHED_KM:
            cgr, enml = PUBLISHED_KM[name]
            print(f" (published, real: CGR {cgr} km, EnML {enml} km, ratio {enml / cgr:.1f})")
        else:
            print()
        show(row)
    print("\nAll (published, real: CGR 4.79 km, EnML 8.13 km, ratio 1.7)")
    show({method: summed(row[method] for row in per_map.values()) for method in methods})
    plot(per_map, given.plot)
    print(f"\n{given.plot}")


def show(row: dict[str, Tally]) -> None:
    """A line per method, and the ratios of the first to the others."""
    for method, tally in row.items():
        p95_ms = 1e3 * float(np.percentile(tally.seconds, 95))
        print(f"  {method:5s} {told(tally)}, p95 {p95_ms:.1f} ms of processor time", flush=True)
    if "enml" in row:
        for method, tally in row.items():
            if method != "enml":
                print(f"  enml/{method}: {told_ratio(row['enml'], tally)}")


if __name__ == "__main__":
    main()
