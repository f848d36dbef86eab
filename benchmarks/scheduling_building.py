"""What transfers save in a building where shifts and capacities bind, and where they do not.

Few items: the exact method with transfers against the proved optimum without. Many items: the
search with transfers against PyVRP (`pip install 'mend-robots[peers]'`; it knows no transfers) for
as long.
The same buildings with nothing that binds are the loose case.

    python benchmarks/scheduling_building.py [--draws 12] [--seconds 60] [--large 4]
        [--large-seconds 60] [--seed 1] [--quick]
"""

# ruff: noqa: T201
import argparse
import time
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from statistics import mean

from office_building import (
    BINDING,
    LOOSE,
    BuildingPlan,
    building_deliveries,
)

from mend.fleet.scheduling.alns.solve import prepare, solve_alns
from mend.fleet.scheduling.drawing.bars import BarGroup, bars
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.problem_file import problem_of
from mend.fleet.scheduling.solution import Solution, Status, UnsupportedError

OUT = Path("out/scheduling_building.svg")
LARGE = replace(BINDING, floors=4, robots=4, items=40, capacity=10.0, shift_s=1100.0, wing_m=100.0)
"""Four robots that bring forty items, in shifts long enough for three wings but not for four."""
HELPS = 1e-4
"""From which share on a saving is one."""
WARM_S = 1.0
"""How long the search with transfers looks for what the exact method begins with (seconds)."""


@dataclass(frozen=True, slots=True)
class Draw:
    """One building without and with transfers."""

    name: str
    alone: Solution
    shared: Solution

    @property
    def saving(self) -> float | None:
        """What transfers save, as a share; None where one of the two has no schedule."""
        if self.alone.cost is None or self.shared.cost is None:
            return None
        return 1 - self.shared.cost.total / self.alone.cost.total

    @property
    def proved(self) -> bool:
        """Whether the optimum without transfers is proved."""
        return self.alone.status in (Status.OPTIMAL, Status.INFEASIBLE)


def drawn(plan: BuildingPlan, number: int, seed: int) -> Problem:
    """One problem of a kind of building."""
    return problem_of(building_deliveries(plan, Random(1000 * seed + number), f"draw{number}"))


def measure_exactly(problem: Problem, seconds: float, seed: int) -> Draw:
    """The proved optimum without transfers, and the best that is found with them."""
    apart = problem.without_transfers()
    begin = solve_alns(apart, seconds=WARM_S, seed=seed, clock=time.perf_counter)
    alone = solve_exactly(
        apart, seconds=seconds, seed=seed, start=begin.schedule, clock=time.perf_counter
    )
    warm = solve_alns(
        problem, seconds=WARM_S, seed=seed, start=alone.schedule, clock=time.perf_counter
    )
    shared = solve_exactly(
        problem, seconds=seconds, seed=seed, start=warm.schedule, clock=time.perf_counter
    )
    return Draw(problem.name, alone, shared)


def measure_large(problem: Problem, seconds: float, seed: int) -> Draw | None:
    """PyVRP without transfers and the search with them; None where there is no PyVRP."""
    try:
        from peers.pyvrp_search import solve_by_pyvrp
    except ImportError:
        print("PyVRP is not installed here; pip install 'mend-robots[peers]'")
        return None
    try:
        alone = solve_by_pyvrp(
            problem.without_transfers(), seconds=seconds, seed=seed, clock=time.perf_counter
        )
    except UnsupportedError as error:
        print(error)
        return None
    shared = solve_alns(problem, seconds=seconds, seed=seed, clock=time.perf_counter)
    return Draw(problem.name, alone, shared)


def print_draw(kind: str, draw: Draw) -> None:
    """One line for one building."""
    costs = [
        "      -" if each.cost is None else f"{each.cost.total:7.1f}"
        for each in (draw.alone, draw.shared)
    ]
    transfers = (
        "" if draw.shared.schedule is None else f"{draw.shared.schedule.transfers} transfers"
    )
    saving = "" if draw.saving is None else f"{100 * draw.saving:5.1f} %"
    print(
        f"{kind:9} {draw.name:8} alone {costs[0]} {draw.alone.status:10} "
        f"shared {costs[1]} {draw.shared.status:10} {saving:8} {transfers}",
        flush=True,
    )


def print_summary(kind: str, draws: list[Draw]) -> BarGroup:
    """Mean and greatest saving, what is feasible only with transfers; as a row of the plot."""
    savings = [each.saving for each in draws if each.saving is not None]
    only = sum(each.alone.cost is None and each.shared.cost is not None for each in draws)
    neither = sum(each.alone.cost is None and each.shared.cost is None for each in draws)
    helped = sum(saving > HELPS for saving in savings)
    print(
        f"{kind:9} mean saving {100 * mean(savings or [0.0]):5.1f} %, greatest "
        f"{100 * max(savings, default=0.0):5.1f} %, helped {helped} of {len(savings)}; "
        f"only with transfers {only} of {len(draws)}, neither {neither}; "
        f"without transfers proved {sum(each.proved for each in draws)}"
    )
    average = 100 * mean(savings) if savings else None
    return BarGroup(kind, (average, 100 * only / len(draws)))


def main() -> None:
    """Read the command line, measure, print the table, draw the plot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=12)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--large", type=int, default=4, help="how many buildings with 40 items")
    parser.add_argument("--large-seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="3 draws of 10 s, 1 large of 10 s")
    options = parser.parse_args()
    if options.quick:
        options.draws, options.seconds, options.large, options.large_seconds = 3, 10.0, 1, 10.0
    prepare()
    kinds = {
        "4 items": replace(BINDING, items=4),
        "5 items": replace(BINDING, items=5),
        "loose": replace(LOOSE, items=4),
    }
    found: dict[str, list[Draw]] = {}
    for kind, plan in kinds.items():
        found[kind] = []
        for number in range(options.draws):
            problem = drawn(plan, number, options.seed)
            found[kind].append(measure_exactly(problem, options.seconds, options.seed))
            print_draw(kind, found[kind][-1])
    for number in range(options.large):
        problem = drawn(LARGE, number, options.seed)
        draw = measure_large(problem, options.large_seconds, options.seed)
        if draw is not None:
            found.setdefault("4 x 40", []).append(draw)
            print_draw("4 x 40", draw)
    print()
    groups = [print_summary(kind, draws) for kind, draws in found.items()]
    OUT.parent.mkdir(parents=True, exist_ok=True)
    series = ("mean saving in percent", "feasible only with transfers in percent")
    OUT.write_text(bars("What transfers save in a building", "", series, groups), encoding="utf-8")
    print(f"plot: {OUT}")


if __name__ == "__main__":
    main()
