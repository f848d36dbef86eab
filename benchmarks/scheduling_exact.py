"""The exact method on Lyu and Yu's instances with windows, against the published optima.

The naive way runs beside it for as long: the constraint model with nothing to begin with and no
routes.
Published MIPs had an hour each. The quick heuristics that the exact method begins with are counted.

    python benchmarks/scheduling_exact.py [--set pdptwt|pdpt] [--seconds 300] [--instances 20]
        [--seed 1] [--no-naive] [--quick] [--data FOLDER]
"""

# ruff: noqa: T201
import argparse
import csv
import os
import random
import time
from collections import defaultdict
from dataclasses import dataclass
from math import inf, isfinite
from pathlib import Path
from statistics import median

from mend.fleet.scheduling.drawing.bars import BarGroup, bars
from mend.fleet.scheduling.exact.constraint_search import Effort, search
from mend.fleet.scheduling.exact.model import Rounding
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.methods import solve
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.solution import Solution, Status

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data")) / "scheduling"
OUT = Path("out/scheduling_exact.svg")
SAME = 1e-4
"""Two costs are equal when they differ by less than this share."""
SETTLED = (Status.OPTIMAL, Status.INFEASIBLE)


@dataclass(frozen=True, slots=True)
class Published:
    """The best published objective, whether it is proved, and the fastest MIP's seconds."""

    objective: float
    proved: bool
    seconds: float


@dataclass(frozen=True, slots=True)
class Row:
    """One instance: what is published, what was found, and what the naive way took."""

    name: str
    published: Published
    solution: Solution
    seconds: float
    naive: Solution | None
    naive_seconds: float

    @property
    def settled(self) -> bool:
        """Whether it is solved: a proved optimum, or proved infeasible."""
        return self.solution.status in SETTLED

    @property
    def matched(self) -> bool:
        """Whether a published optimum was found and proved."""
        cost = self.solution.cost
        return (
            self.settled
            and cost is not None
            and abs(cost.total - self.published.objective) <= SAME * self.published.objective
        )


def published_results(path: Path) -> dict[str, Published]:
    """The best of the published MIPs for each instance."""
    results: dict[str, Published] = {}
    with path.open() as file:
        for row in csv.DictReader(file):
            name = row["instance"].removesuffix(".txt")
            objective = float(row["objective"]) if row["objective"] else inf
            proved = row["status"] == "OPTIMAL"
            seconds = float(row["seconds"]) if proved else inf
            before = results.get(name, Published(inf, False, inf))
            results[name] = Published(
                min(before.objective, objective),
                before.proved or proved,
                min(before.seconds, seconds),
            )
    return results


def measure(problem: Problem, published: Published, options: argparse.Namespace) -> Row:
    """Both ways on one instance."""
    begun_s = time.perf_counter()
    solution = solve(
        problem, "exact", seconds=options.seconds, seed=options.seed, clock=time.perf_counter
    )
    took_s = time.perf_counter() - begun_s
    if options.no_naive:
        return Row(problem.name, published, solution, took_s, None, inf)
    begun_s = time.perf_counter()
    naive = search(problem, Rounding.UP, Effort(options.seconds, options.seed, workers=2))
    naive_s = time.perf_counter() - begun_s
    return Row(problem.name, published, solution, took_s, naive, naive_s)


def print_row(row: Row) -> None:
    """One line for one instance."""
    cost, bound = row.solution.cost, row.solution.bound
    mark = "optimum" if row.published.proved else "open"
    found = "-" if cost is None else f"{cost.total:.2f}"
    proved = "-" if bound is None else f"{bound:.2f}"
    naive = "" if row.naive is None else f"naive {row.naive.status:10} {row.naive_seconds:6.1f} s"
    print(
        f"{row.name:24} {mark:7} {row.published.objective:8.2f} {row.published.seconds:7.1f} s  "
        f"{row.solution.status:10} {found:>8} bound {proved:>8} {row.seconds:6.1f} s  {naive}",
        flush=True,
    )


def print_table(rows: list[Row]) -> str:
    """Settled share, matched optima, closed open ones and median times by class."""
    classes: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        size = row.name.split("-")[1 if row.name.startswith("PDPT") else 0]
        classes[size].append(row)
    classes["all"] = rows
    print(f"\n{'class':6} {'n':>3} {'settled':>8} {'matched':>9} {'open closed':>12}", end="")
    print(f" {'median':>9} {'naive settled':>14} {'naive':>9} {'MIP':>9}")
    line = ""
    for name, members in classes.items():
        known = [row for row in members if row.published.proved]
        opened = [row for row in members if not row.published.proved]
        matched = f"{sum(row.matched for row in known)}/{len(known)}"
        closed = f"{sum(row.settled for row in opened)}/{len(opened)}"
        settled = sum(row.settled for row in members) / len(members)
        naive = [row for row in members if row.naive is not None]
        naive_settled = sum(row.naive.status in SETTLED for row in naive if row.naive)
        print(
            f"{name:6} {len(members):3d} {settled:8.0%} {matched:>9} {closed:>12}"
            f" {_median([row.seconds for row in members]):>9}"
            f" {f'{naive_settled}/{len(naive)}':>14} {_median([r.naive_seconds for r in naive]):>9}"
            f" {_median([row.published.seconds for row in members]):>9}"
        )
        line = (
            f"settled {settled:.0%}, published optima matched {matched}, open ones closed {closed}"
        )
    return line


def _median(seconds: list[float]) -> str:
    if not seconds:
        return "-"
    middle = median(seconds)
    return f"{middle:.1f} s" if isfinite(middle) else "> 1 h"


def main() -> None:
    """Read the command line, measure a seeded sample, print the table, draw the plot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA, help="the folder with pdpt and pdptwt")
    parser.add_argument("--set", choices=("pdptwt", "pdpt"), default="pdptwt")
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--instances", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--no-naive", action="store_true", help="without the naive way")
    parser.add_argument("--quick", action="store_true", help="4 instances, 10 s each")
    options = parser.parse_args()
    if options.quick:
        options.instances, options.seconds = 4, 10.0
    folder = options.data / options.set
    if not folder.is_dir():
        parser.error(f"there are no instances in {folder}; --data says where they are")
    published = published_results(folder / "published_mip.csv")
    paths = [path for path in sorted(folder.glob("*.txt")) if path.stem in published]
    random.Random(options.seed).shuffle(paths)
    rows = []
    print("instance, published objective and time, status, cost, bound, time, naive way")
    for path in paths[: options.instances]:
        problem = read_transfer_benchmark(path.read_text(), path.stem)
        rows.append(measure(problem, published[path.stem], options))
        print_row(rows[-1])
    summary = print_table(rows)
    groups = [
        BarGroup(row.name, (row.seconds, row.naive_seconds, row.published.seconds)) for row in rows
    ]
    OUT.parent.mkdir(parents=True, exist_ok=True)
    series = ("mend", "naive", "published MIP (none: over 1 h)")
    OUT.write_text(bars("Seconds until it was over", summary, series, groups), encoding="utf-8")
    print(f"plot: {OUT}")


if __name__ == "__main__":
    main()
