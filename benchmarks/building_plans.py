"""Plans of other people: is each imported, all of it reached, and are deliveries planned?

    python benchmarks/building_plans.py FOLDER [--items 20] [--robots 3] [--seed 0] [--seconds 10]

Every `*.building.yaml` (Open-RMF) and `*.navigation.json` (CoBot) below FOLDER. Deliveries are
drawn between places that are no waypoints (all where there are too few); each plan is judged
by the checker of schedules. Beside it what the nearest robot would do, one item after the other.
The exit code is 1 where a plan is not imported, a place not reached or an item not planned.
"""

# ruff: noqa: T201

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from mend.documents.document import read_document, read_text
from mend.fleet.scheduling.building_travel import travel_in
from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.methods import solve
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights
from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.building_file import building_text, check_building, read_building_text
from mend.maps.building.cobot import CobotFloor, import_cobot
from mend.maps.building.open_rmf import import_open_rmf
from mend.maps.building.tidying import Imported
from mend.maps.vector_map_file import read_vector_map


def imported(path: Path) -> Imported:
    """Raises `WrongInputError`."""
    content = read_document(read_text(path))[0]
    if path.suffix == ".yaml":
        return import_open_rmf(content)
    name = path.name.split(".")[0]
    walls = path.with_name(f"{name}.vectormap.json")
    floor = CobotFloor(content, read_vector_map(walls) if walls.exists() else None)
    return import_cobot(name, {name: floor})


def goals_of(building: Building) -> list[str]:
    """Where somebody may want something; on a plan that names nothing, everywhere."""
    kinds = [each for each in PlaceKind if each not in (PlaceKind.WAYPOINT, PlaceKind.ELEVATOR)]
    named = [name for kind in kinds for name in building.of_kind(kind)]
    return named if len(named) > 1 else [each.name for each in building.graph.places]


def deliveries_in(building: Building, items: int, robots: int, seed: int) -> Problem:
    """Items between drawn goals, robots at drawn goals; cabins and rooms are transfer places."""
    rng = np.random.default_rng(seed)
    places = goals_of(building) + building.of_kind(PlaceKind.ELEVATOR)
    goals = len(goals_of(building))
    ends = [rng.choice(goals, 2, replace=False).tolist() for _ in range(items)]
    return Problem(
        name=building.name,
        places=tuple(places),
        travel=travel_in(building.graph, 0.8, places),
        robots=tuple(Robot(f"r{n}", int(rng.integers(goals)), None, 4.0) for n in range(robots)),
        items=tuple(Item(f"i{n}", 1.0, Visit(a), Visit(b)) for n, (a, b) in enumerate(ends)),
        transfers=Transfers(tuple(range(goals, len(places))), service_s=5.0),
        weights=Weights(distance=0.1, completion=1.0),
    )


def judge(path: Path, arguments: argparse.Namespace) -> bool:
    """Print one plan's row; whether all is well."""
    began_s = time.process_time()
    read = imported(path)
    took_s = time.process_time() - began_s
    building = read_building_text(building_text(read.document))
    reached = bool(np.isfinite(building.graph.shortest(1.0)[0]).all())
    problem = deliveries_in(building, arguments.items, arguments.robots, arguments.seed)
    plans = {
        name: solve(problem, name, seconds=arguments.seconds, clock=time.monotonic)
        for name in ("alns", "greedy")
    }
    costs = [each.cost.total if each.cost else np.nan for each in plans.values()]
    wrong = [*check_building(read.document)]
    for each in plans.values():
        wrong += check(problem, each.schedule) if each.schedule else ["no schedule"]
    document = read.document
    print(
        f"{path.name:28} {len(document.floors):2} floors {len(building.graph.places):4} places "
        f"{sum(len(each.doors) for each in document.floors.values()):4} doors "
        f"{len(document.elevators)} elevators  {took_s:5.2f} s  "
        f"{'all reached' if reached else 'NOT ALL REACHED'}  cost {costs[0]:8.1f}, "
        f"nearest next {costs[1]:8.1f}: {costs[1] / costs[0]:.2f} x"
    )
    for note in read.notes:
        print(f"    {note}")
    for mistake in wrong:
        print(f"    WRONG: {mistake}")
    return reached and not wrong


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--items", type=int, default=20)
    parser.add_argument("--robots", type=int, default=3)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=10.0)
    arguments = parser.parse_args()
    if arguments.folder is None:
        print("no folder with plans was given: nothing is measured")
        return
    plans = sorted(
        [*arguments.folder.rglob("*.building.yaml"), *arguments.folder.rglob("*.navigation.json")]
    )
    if not plans:
        sys.exit(f"{arguments.folder} has no *.building.yaml and no *.navigation.json")
    good = [judge(each, arguments) for each in plans]
    print(f"{sum(good)} of {len(good)} plans: imported, all reached, deliveries planned")
    if not all(good):
        sys.exit(1)


if __name__ == "__main__":
    main()
