"""How often a way leads round one blocked hallway, and takes little longer, in drawn buildings.

    python benchmarks/ways_round.py [--first 0] [--buildings 6] [--rooms 60] [--drives 12]

On maps alone, without robots: for drives between rooms that are drawn, one lane of the hallways on
the way is blocked, and a robot that stands before it turns back.
"""

# ruff: noqa: T201
import argparse
import random
from itertools import pairwise

from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building
from mend.maps.navigation import NavigationGraph
from mend.robots.base.behaviors.going_round import ASKS_BEYOND_S
from mend.sim.building.gatherings import blocked_lanes

SPEED_M_S = 1.0


def way_of(graph: NavigationGraph, start: str, goal: str) -> tuple[list[str], float]:
    """The places on the quickest way, and the seconds that it takes."""
    path = graph.quickest_path(graph.index(start), graph.index(goal), SPEED_M_S)
    return [graph.places[each].name for each, _ in path], path[-1][1] if path else 0.0


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--buildings", type=int, default=6)
    parser.add_argument("--rooms", type=int, default=60)
    parser.add_argument("--drives", type=int, default=12)
    options = parser.parse_args()
    rng, longer_s, met = random.Random(options.first), list[float](), 0
    for seed in range(options.first, options.first + options.buildings):
        building = Building(random_building(seed, 1, options.rooms))
        graph, rooms = building.graph, building.of_kind(PlaceKind.ROOM)
        hallways = {frozenset(each) for each in blocked_lanes(building, 1.0, seed)}
        for _ in range(options.drives):
            start, goal = rng.sample(rooms, 2)
            lanes = list(pairwise(way_of(graph, start, goal)[0]))
            lanes = [each for each in lanes if frozenset(each) in hallways]
            if not lanes:
                continue
            met += 1
            before, beyond = rng.choice(lanes)
            left = [e for e in graph.ways if {e.a, e.b} != {before, beyond}]
            way, takes_s = way_of(NavigationGraph(graph.places, left), before, goal)
            if way:
                longer_s.append(takes_s - way_of(graph, before, goal)[1])
    short = sum(each <= ASKS_BEYOND_S for each in longer_s)
    print(f"{met} drives: another way for {len(longer_s)}, for {short} longer by 60 s at most")


if __name__ == "__main__":
    main()
