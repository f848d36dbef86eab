"""The peer of the corridors' benchmark: nobody is ever where another is, and none cheats."""

from itertools import combinations, pairwise
from random import Random

from building_corridors import Goals
from hypothesis import given, settings
from hypothesis import strategies as st
from peers.cooperative_astar import Planned, steps_of

from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building

OFFICE = Building(random_building(2, 2, 6))
PLACES = [
    each.name for each in OFFICE.graph.places if each.name not in OFFICE.of_kind(PlaceKind.ELEVATOR)
]
UNTIL_S = 60


def drives(seed: int, robots: int) -> dict[str, list[tuple[tuple[str, ...], int]]]:
    """Where each robot was from which second on, in a minute of driving."""
    starts = {f"r{n}": at for n, at in enumerate(Random(seed).sample(PLACES, robots))}
    peer, goals = Planned(OFFICE, starts), Goals(PLACES, seed)
    goals.of.update(starts)
    wants: dict[str, str] = {}
    been = {robot: list(peer.paths[robot]) for robot in starts}
    for now_s in range(UNTIL_S):
        peer.forget_before(now_s)
        for robot in starts:
            if peer.arrives_s(robot) <= now_s:
                if robot not in wants:
                    wants[robot] = goals.next_for(robot)
                if now_s % 5 == 0 and peer.plan(robot, wants[robot], now_s):
                    del wants[robot]
                    been[robot] += peer.paths[robot]
    return been


def at_each_second(path: list[tuple[tuple[str, ...], int]]) -> dict[int, tuple[str, ...]]:
    """Who rides is at the stop where they got in until they are there."""
    where: dict[int, tuple[str, ...]] = {}
    for (node, begin_s), (_, end_s) in pairwise([*path, (path[-1][0], UNTIL_S * 10)]):
        for second in range(begin_s, max(end_s, begin_s + 1)):
            where[second] = node
    return where


@settings(max_examples=4, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 6))
def test_no_two_robots_are_at_one_place_or_change_places(seed: int, robots: int) -> None:
    where = {robot: at_each_second(path) for robot, path in drives(seed, robots).items()}
    for a, b in combinations(where.values(), 2):
        for second in range(UNTIL_S):
            assert a[second] != b[second]
            assert (a[second], a[second + 1]) != (b[second + 1], b[second])


def test_nobody_jumps() -> None:
    moves = steps_of(OFFICE)
    for path in drives(7, 4).values():
        for (a, begin_s), (b, end_s) in pairwise(path):
            if a != b:
                assert end_s - begin_s in {each.takes_s for each in moves[a] if each.to == b}


def test_goals_are_the_same_for_all_and_never_anybody_elses() -> None:
    one, other = Goals(PLACES, 3), Goals(PLACES, 3)
    first = [one.next_for(f"r{n}") for n in range(10)]
    assert first == [other.next_for(f"r{n}") for n in range(10)]
    assert len(set(first)) == 10
