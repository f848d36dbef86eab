"""The search with transfers against published optima and incumbents (three MIPs, an hour each).

The naive way runs beside it for as long: cheapest insertion without transfers in random order,
again and again. Seconds are of this process's own processor time unless `--clock wall`.

    python benchmarks/scheduling_transfers.py [--set pdptwt|pdpt] [--only proved|open]
        [--seconds 10] [--instances 20] [--seed 1] [--quick] [--data FOLDER]
"""

# ruff: noqa: T201
import argparse
import csv
import os
import random
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from math import inf, isfinite
from pathlib import Path
from statistics import mean

import numpy as np

from mend.fleet.scheduling.alns.itineraries import Allowed
from mend.fleet.scheduling.alns.plan import BANKED, plan_value
from mend.fleet.scheduling.alns.problem_arrays import problem_arrays
from mend.fleet.scheduling.alns.repair import Repair, repair
from mend.fleet.scheduling.alns.solve import prepare, solve_alns
from mend.fleet.scheduling.alns.state import state_for
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.rng import rng_from

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data")) / "scheduling"
SAME = 1e-4
"""Two costs are equal when they differ by less than this share."""


@dataclass(frozen=True, slots=True)
class Published:
    """The best of the published results; `proved` where one of them is optimal."""

    objective: float
    proved: bool


@dataclass(frozen=True, slots=True)
class Result:
    """One instance: what is published, what the naive way and the search found."""

    name: str
    published: Published
    naive: float
    found: float
    transfers: int
    found_after_s: float

    @property
    def gap(self) -> float:
        """How much worse than published, as a share; negative where it is better."""
        return self.found / self.published.objective - 1

    @property
    def kind(self) -> str:
        """The class in the table."""
        size = self.name.split("-")[1] if self.name.startswith("PDPT") else self.name.split("-")[0]
        return f"{size} {'proved' if self.published.proved else 'open'}"


def published_results(folder: Path) -> dict[str, Published]:
    """The best published result of each instance; an infinite objective where there is none."""
    results: dict[str, Published] = {}
    with (folder / "published_mip.csv").open() as file:
        for row in csv.DictReader(file):
            name = row["instance"].removesuffix(".txt")
            objective = float(row["objective"]) if row["objective"] else inf
            before = results.get(name, Published(inf, False))
            proved = before.proved or row["status"] == "OPTIMAL"
            results[name] = Published(min(before.objective, objective), proved)
    return results


def naive(problem: Problem, seconds: float, seed: int, clock: Callable[[], float]) -> float:
    """Cheapest insertion without transfers, in random order, until the time is over."""
    arrays = problem_arrays(problem, 1)
    rng, items = rng_from(np.random.default_rng(seed)), len(problem.items)
    best, begun_s = inf, clock()
    while clock() - begun_s < seconds:
        state = state_for(arrays)
        state.chosen[:items] = np.arange(items)
        repair(arrays, state, rng, int(Repair.GREEDY), Allowed(0, False, 0.0), (items, inf))
        if not (state.trial.transfers == BANKED).any():
            best = min(best, float(plan_value(arrays, state.trial)))
    return best


def measure(
    path: Path, published: Published, seconds: float, seed: int, clock: Callable[[], float]
) -> Result:
    """Both ways on one instance, for the same time each."""
    problem = read_transfer_benchmark(path.read_text(), path.stem)
    plain = naive(problem, seconds, seed, clock)
    found_after_s = 0.0
    told = []
    solution = solve_alns(problem, seconds=seconds, seed=seed, clock=clock, on_progress=told.append)
    if told:
        found_after_s = told[-1].seconds
    found = inf if solution.cost is None else solution.cost.total
    transfers = 0 if solution.schedule is None else solution.schedule.transfers
    return Result(path.stem, published, plain, found, transfers, found_after_s)


def print_result(result: Result) -> None:
    """One line for one instance."""
    published = result.published
    mark = "optimum" if published.proved else "incumbent"
    gap = f"{100 * result.gap:+7.2f} %" if isfinite(published.objective) else "        -"
    print(
        f"{result.name:26} {mark:9} {published.objective:9.2f} naive {result.naive:9.2f} "
        f"found {result.found:9.2f} {gap} {result.transfers:2d} transfers "
        f"last better after {result.found_after_s:5.1f} s",
        flush=True,
    )


def print_table(results: list[Result]) -> None:
    """Per class: gaps, optima found, better than published; the naive way's gap beside it."""
    classes: dict[str, list[Result]] = defaultdict(list)
    for result in results:
        classes[result.kind].append(result)
        classes["all proved" if result.published.proved else "all open"].append(result)
    print(f"\n{'class':12} {'n':>3} {'mean gap':>9} {'naive':>9} {'equal':>7} {'better':>7}")
    for kind, members in sorted(classes.items(), key=lambda each: (each[0][:3] == "all", each[0])):
        known = [each for each in members if isfinite(each.published.objective)]
        gaps = [each.gap for each in known if isfinite(each.found)]
        plain = [
            each.naive / each.published.objective - 1 for each in known if isfinite(each.naive)
        ]
        equal = sum(abs(each.gap) < SAME for each in known)
        better = sum(each.found < each.published.objective * (1 - SAME) for each in members)
        print(
            f"{kind:12} {len(members):3d} {_percent(gaps):>9} {_percent(plain):>9} "
            f"{equal / len(members):7.0%} {better / len(members):7.0%}"
        )
    nothing = sum(not isfinite(each.found) for each in results)
    alone = sum(not isfinite(each.naive) for each in results)
    print(f"no schedule: {nothing} of {len(results)} (naive: {alone})")


def _percent(shares: list[float]) -> str:
    return f"{100 * mean(shares):.2f} %" if shares else "-"


def main() -> None:
    """Read the command line, measure a seeded sample, print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA, help="the folder with pdpt and pdptwt")
    parser.add_argument("--set", choices=("pdptwt", "pdpt"), default="pdptwt")
    parser.add_argument("--only", choices=("proved", "open"), default=None)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--instances", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--clock", choices=("processor", "wall"), default="processor")
    parser.add_argument("--quick", action="store_true", help="6 instances, 2 s each")
    options = parser.parse_args()
    if options.quick:
        options.instances, options.seconds = 6, 2.0
    clock = time.perf_counter if options.clock == "wall" else time.process_time
    folder = options.data / options.set
    if not folder.is_dir():
        parser.error(f"there are no instances in {folder}; --data says where they are")
    published = published_results(folder)
    wanted = None if options.only is None else options.only == "proved"
    paths = [
        path
        for path in sorted(folder.glob("*.txt"))
        if path.stem in published and wanted in (None, published[path.stem].proved)
    ]
    random.Random(options.seed).shuffle(paths)
    begun_s = time.perf_counter()
    prepare()
    print(f"kernels ready after {time.perf_counter() - begun_s:.1f} s (not counted)")
    results = []
    for path in paths[: options.instances]:
        result = measure(path, published[path.stem], options.seconds, options.seed, clock)
        print_result(result)
        results.append(result)
    print_table(results)


if __name__ == "__main__":
    main()
