"""Navigation graphs: the quickest ways through what is open."""

from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.maps.navigation import NavigationError, NavigationGraph, Place, Way, WayKind

PLACES = (Place("hall", 0, 0), Place("office", 30, 40), Place("lab", 30, 40, floor=1))
ELEVATOR = Way("office", "lab", WayKind.ELEVATOR, length_m=0.0, delay_s=100.0)


def test_elevator_takes_its_time_and_no_distance() -> None:
    graph = NavigationGraph(PLACES, (Way("hall", "office"), ELEVATOR))
    distance_m, time_s = graph.shortest(2.0)
    assert distance_m[0].tolist() == [0.0, 50.0, 50.0]
    assert time_s[0].tolist() == [0.0, 25.0, 125.0]


def test_closed_way_is_gone_round_or_nothing() -> None:
    detour = Way("hall", "office", length_m=90.0)
    shut = Way("hall", "office", WayKind.DOOR, closed=True)
    distance_m, _ = NavigationGraph(PLACES, (shut, detour)).shortest(1.0)
    assert distance_m[0, 1] == 90.0
    assert distance_m[0, 2] == inf


def test_door_counts_only_while_it_is_open() -> None:
    door = Way("hall", "office", WayKind.DOOR, open_s=((100.0, 200.0),))
    graph = NavigationGraph(PLACES, (door,))
    assert graph.changes_s() == [100.0, 200.0]
    assert graph.shortest(1.0, from_s=120.0, until_s=180.0)[1][0, 1] == 50.0
    assert graph.shortest(1.0, from_s=120.0, until_s=210.0)[1][0, 1] == inf


@pytest.mark.parametrize(
    ("ways", "words"),
    [
        ((Way("hall", "moon"),), "there is no place 'moon'"),
        ((Way("office", "lab"),), "joins two floors, but is no elevator"),
        ((Way("hall", "hall"),), "leads nowhere"),
        ((Way("hall", "office", open_s=((5.0, 2.0),)),), "closes before it opens"),
        ((Way("hall", "office", delay_s=-1.0),), "must be at least 0"),
    ],
)
def test_graph_that_makes_no_sense_is_refused(ways: tuple[Way, ...], words: str) -> None:
    with pytest.raises(NavigationError, match=words):
        NavigationGraph(PLACES, ways)


@given(
    st.lists(
        st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(0, 50)).filter(
            lambda edge: edge[0] != edge[1]
        ),
        max_size=12,
    )
)
@settings(deadline=None)
def test_times_equal_those_of_floyd_and_warshall(edges: list[tuple[int, int, int]]) -> None:
    places = [Place(str(number), float(number), 0.0) for number in range(6)]
    ways = [Way(str(a), str(b), length_m=float(length)) for a, b, length in edges]
    distance_m, time_s = NavigationGraph(places, ways).shortest(1.0)
    plain = np.full((6, 6), inf)
    np.fill_diagonal(plain, 0.0)
    for a, b, length in edges:
        plain[a, b] = plain[b, a] = min(plain[a, b], float(length))
    for via in range(6):
        plain = np.minimum(plain, plain[:, via : via + 1] + plain[via : via + 1, :])
    assert np.allclose(time_s, plain, atol=1e-6)
    assert np.allclose(distance_m, plain, atol=1e-6)


def test_of_an_elevator_all_rides_are_closed_together() -> None:
    floors = [Place(f"{n}/lift", 0.0, 0.0, n) for n in range(3)]
    others = [Place("0/hall", 3.0, 0.0), Place("0/other", 6.0, 0.0), Place("1/other", 6.0, 0.0, 1)]
    rides = [("0/lift", "1/lift"), ("0/lift", "2/lift"), ("1/lift", "2/lift")]
    ways = [Way(a, b, WayKind.ELEVATOR, length_m=0.0) for a, b in rides]
    ways += [Way("0/hall", "0/lift"), Way("0/hall", "0/other")]
    ways += [Way("0/other", "1/other", WayKind.ELEVATOR, length_m=0.0)]
    graph = NavigationGraph([*floors, *others], ways)
    assert graph.together(("2/lift", "1/lift")) == {frozenset(each) for each in rides}
    assert graph.together(("0/lift", "0/hall")) == {frozenset(("0/lift", "0/hall"))}
    assert graph.together(("0/other", "1/other")) == {frozenset(("0/other", "1/other"))}
    assert not graph.together(("0/lift", "0/other"))
