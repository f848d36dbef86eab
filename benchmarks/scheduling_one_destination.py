"""Everything to one destination: how far the walk and its sharing are from the proved optimum.

Random squares with robots anywhere and transfers anywhere; the exact method proves the optimum, or
its bound stands in where it has no time. The naive way beside it: one item at a time.

    python benchmarks/scheduling_one_destination.py [--instances 30] [--seconds 20] [--quick]
"""

# ruff: noqa: T201
import argparse
import time
from random import Random
from statistics import mean

from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.one_destination import solve_to_one_destination
from mend.fleet.scheduling.one_task_bidder import solve_one_task_each
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit
from mend.fleet.scheduling.solution import Solution, Status
from mend.fleet.scheduling.travel import Travel

SIDE_M = 100.0


def collection(items: int, robots: int, chance: Random) -> Problem:
    """Items all over a square, to be brought to its first place."""
    count = 1 + items + robots
    points = [(chance.uniform(0, SIDE_M), chance.uniform(0, SIDE_M)) for _ in range(count)]
    return Problem(
        "collection",
        tuple(f"place{n}" for n in range(count)),
        Travel.euclidean(points),
        tuple(Robot(f"robot{n}", 1 + items + n, None, float(items)) for n in range(robots)),
        tuple(Item(f"item{n}", 1.0, Visit(1 + n), Visit(0)) for n in range(items)),
        Transfers(tuple(range(count))),
    )


def total(solution: Solution) -> float:
    """The cost of a solution that has a schedule."""
    assert solution.cost is not None
    return solution.cost.total


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--instances", type=int, default=30)
    parser.add_argument("--most", type=int, default=5, help="the most items of an instance")
    parser.add_argument("--seconds", type=float, default=20.0, help="for the exact method")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="8 instances of at most 4 items")
    options = parser.parse_args()
    if options.quick:
        options.instances, options.most = 8, 4
    chance, clock = Random(options.seed), time.process_time
    walks, shares, naives = [], [], []
    print(f"{'items':>5} {'robots':>6} {'walk':>8} {'shared':>8} {'naive':>8} {'optimum':>8}")
    for _ in range(options.instances):
        problem = collection(chance.randint(2, options.most), chance.randint(1, 3), chance)
        walk = total(solve_to_one_destination(problem, seconds=0.0, clock=clock))
        shared = solve_to_one_destination(problem, seconds=2.0, seed=1, clock=clock)
        naive = total(solve_one_task_each(problem, seconds=1.0, clock=clock))
        best = solve_exactly(problem, seconds=options.seconds, start=shared.schedule, clock=clock)
        proved = best.status is Status.OPTIMAL
        least = total(best) if proved else (best.bound or 0.0)
        mark = "" if proved else " (only its bound)"
        print(
            f"{len(problem.items):5d} {len(problem.robots):6d} {walk:8.2f} {total(shared):8.2f} "
            f"{naive:8.2f} {least:8.2f}{mark}",
            flush=True,
        )
        if proved:
            walks.append(walk / least)
            shares.append(total(shared) / least)
            naives.append(naive / least)
    print(f"\n{len(walks)} of {options.instances} proved; ratio to the optimum")
    for name, ratios in (("walk", walks), ("shared", shares), ("one item at a time", naives)):
        print(f"  {name:18} mean {mean(ratios):.3f} max {max(ratios):.3f}")


if __name__ == "__main__":
    main()
