"""The search without transfers on Li and Lim's instances: vehicles first, then distance.

OR-Tools' routing library runs beside it for as long; PyVRP and VROOM too, where they are installed
(`pip install 'mend-robots[peers]'`). Compiling is not counted.

    python benchmarks/scheduling_lilim.py [--set pdp_100] [--seconds 60] [--instances 56]
        [--seed 1] [--peers ortools,pyvrp,vroom] [--quick] [--data FOLDER]
"""

# ruff: noqa: T201
import argparse
import csv
import os
import random
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from math import inf, isfinite
from pathlib import Path
from statistics import mean

from mend.fleet.scheduling.alns.solve import prepare, solve_alns
from mend.fleet.scheduling.drawing.bars import BarGroup, bars
from mend.fleet.scheduling.instances.li_lim import read_li_lim
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.solution import Solution

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data")) / "scheduling"
OUT = Path("out/scheduling_lilim.svg")
SAME = 1e-4
"""Two distances are equal when they differ by less than this share."""
PEERS = {
    "ortools": ("peers.ortools_routing", "solve_by_ortools_routing"),
    "pyvrp": ("peers.pyvrp_search", "solve_by_pyvrp"),
    "vroom": ("peers.vroom_search", "solve_by_vroom"),
}

Solve = Callable[..., Solution]


@dataclass(frozen=True, slots=True)
class Found:
    """Vehicles and distance; infinite where nothing was found."""

    vehicles: float
    distance_m: float

    def ahead_of(self, other: "Found") -> bool:
        """Fewer vehicles, or as many and less distance."""
        if self.vehicles != other.vehicles:
            return self.vehicles < other.vehicles
        return self.distance_m < other.distance_m * (1 - SAME)

    def __str__(self) -> str:
        return f"{self.vehicles:4.0f} {self.distance_m:9.2f}"


@dataclass(frozen=True, slots=True)
class Row:
    """One instance: the best known, and what each method found, Mend's first."""

    name: str
    known: Found | None
    found: tuple[Found, ...]


def best_known(path: Path) -> dict[str, Found]:
    """The best known solutions by the name of the instance."""
    with path.open() as file:
        return {
            row["instance"].lower(): Found(float(row["vehicles"]), float(row["distance"]))
            for row in csv.DictReader(file)
        }


def methods(wanted: list[str]) -> dict[str, Solve]:
    """Mend and the peers that are installed."""
    found: dict[str, Solve] = {"mend": solve_alns}
    for name in wanted:
        module, function = PEERS[name]
        try:
            found[name] = getattr(import_module(module), function)
        except ImportError:
            print(f"{name} is not installed here; pip install 'mend-robots[peers]'")
    return found


def measure(solve: Solve, problem: Problem, seconds: float, seed: int) -> Found:
    """What a method finds in that time."""
    cost = solve(problem, seconds=seconds, seed=seed, clock=time.perf_counter).cost
    return Found(inf, inf) if cost is None else Found(cost.robots, cost.distance_m)


def print_table(names: list[str], rows: list[Row]) -> str:
    """How often each method reaches the best known vehicles, its gap there, and who is ahead.

    Returns the line for the plot.
    """
    print(f"\n{'method':8} {'vehicles best known':>20} {'mean gap where equal':>21}", end="")
    print(f" {'mend ahead':>11} {'equal':>6} {'behind':>7}")
    lines = []
    for number, name in enumerate(names):
        known = [row for row in rows if row.known is not None]
        same = [
            row for row in known if row.known and row.found[number].vehicles == row.known.vehicles
        ]
        gaps = [
            row.found[number].distance_m / row.known.distance_m - 1 for row in same if row.known
        ]
        ahead = sum(row.found[0].ahead_of(row.found[number]) for row in rows)
        behind = sum(row.found[number].ahead_of(row.found[0]) for row in rows)
        gap = f"{100 * mean(gaps):.2f} %" if gaps else "-"
        line = f"{name:8} {f'{len(same)} of {len(known)}':>20} {gap:>21}"
        if number:
            line += f" {ahead:11d} {len(rows) - ahead - behind:6d} {behind:7d}"
        print(line)
        lines.append(f"{name}: best known vehicles on {len(same)} of {len(known)}, gap {gap}")
    return "; ".join(lines)


def plot(names: list[str], rows: list[Row], summary: str, path: Path) -> None:
    """How much longer than the best known each method's schedule is, a vehicle as 10 percent."""

    def bar(row: Row, found: Found) -> float | None:
        if row.known is None or not isfinite(found.vehicles):
            return None
        more = found.vehicles - row.known.vehicles
        return 10 * more if more else 100 * (found.distance_m / row.known.distance_m - 1)

    groups = [BarGroup(row.name, tuple(bar(row, each) for each in row.found)) for row in rows]
    title = "Li and Lim: distance above the best known in percent, each vehicle more as 10"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(bars(title, summary, names, groups), encoding="utf-8")


def main() -> None:
    """Read the command line, measure a seeded sample, print the table, draw the plot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA, help="the folder with li_lim")
    parser.add_argument("--set", choices=("pdp_100", "pdp_200"), default="pdp_100")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--instances", type=int, default=56)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--peers", default=",".join(PEERS))
    parser.add_argument("--quick", action="store_true", help="4 instances, 3 s each")
    options = parser.parse_args()
    if options.quick:
        options.instances, options.seconds = 4, 3.0
    folder = options.data / "li_lim"
    if not folder.is_dir():
        parser.error(f"there are no instances in {folder}; --data says where they are")
    known = best_known(folder / "best_known.csv")
    paths = sorted((folder / options.set).glob("*.txt"))
    random.Random(options.seed).shuffle(paths)
    begun_s = time.perf_counter()
    prepare()
    print(f"kernels ready after {time.perf_counter() - begun_s:.1f} s (not counted)")
    solvers = methods([name for name in options.peers.split(",") if name in PEERS])
    names, rows = list(solvers), []
    print(f"{'instance':9} {'best known':>14} " + " ".join(f"{name:>14}" for name in names))
    for path in sorted(paths[: options.instances]):
        problem = read_li_lim(path.read_text(), path.stem)
        found = [measure(each, problem, options.seconds, options.seed) for each in solvers.values()]
        rows.append(Row(path.stem, known.get(path.stem.lower()), tuple(found)))
        best = str(rows[-1].known or "-")
        print(f"{path.stem:9} {best:>14} " + " ".join(str(each) for each in found), flush=True)
    plot(names, rows, print_table(names, rows), OUT)
    print(f"plot: {OUT}")


if __name__ == "__main__":
    main()
