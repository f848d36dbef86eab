"""The temporal network: earliest and latest times, conflicts and undo."""

from math import inf

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.fleet.scheduling.temporal_network import ORIGIN, TemporalNetwork

EVENTS = 6

edges = st.lists(
    st.tuples(
        st.integers(0, EVENTS), st.integers(0, EVENTS), st.integers(-20, 20).map(float)
    ).filter(lambda edge: edge[0] != edge[1]),
    max_size=16,
)


def network_of(count: int = EVENTS) -> TemporalNetwork[int]:
    network: TemporalNetwork[int] = TemporalNetwork()
    for _ in range(count):
        network.add_event()
    return network


def plain_earliest(kept: list[tuple[int, int, float]]) -> list[float] | None:
    """Bellman and Ford over everything; None when no times fit."""
    kept = [*kept, *((event, ORIGIN, 0.0) for event in range(1, EVENTS + 1))]
    earliest = [0.0] + [-inf] * EVENTS
    for _ in range(EVENTS + 1):
        for later, earlier, gap_s in kept:
            earliest[later] = max(earliest[later], earliest[earlier] + gap_s)
    if any(earliest[earlier] + gap_s > earliest[later] + 1e-9 for later, earlier, gap_s in kept):
        return None
    return earliest


@given(edges)
@settings(deadline=None)
def test_times_equal_those_of_a_plain_evaluation(all_edges: list[tuple[int, int, float]]) -> None:
    network = network_of()
    kept: list[tuple[int, int, float]] = []
    for number, (later, earlier, gap_s) in enumerate(all_edges):
        conflict = network.after(later, earlier, gap_s, number)
        expected = plain_earliest([*kept, (later, earlier, gap_s)])
        assert (conflict is None) == (expected is not None)
        if expected is not None:
            kept.append((later, earlier, gap_s))
    times = plain_earliest(kept)
    assert times is not None
    assert [network.earliest_s(event) for event in range(EVENTS + 1)] == pytest.approx(times)
    for event in range(1, EVENTS + 1):
        latest = network.latest_s(event)
        assert latest >= times[event] - 1e-9
        if latest < inf:
            at_latest = plain_earliest([*kept, (event, ORIGIN, latest)])
            assert at_latest is not None
            assert plain_earliest([*kept, (event, ORIGIN, latest + 0.5)]) is None
        else:
            assert plain_earliest([*kept, (event, ORIGIN, 10_000.0)]) is not None


@given(edges, edges)
@settings(deadline=None)
def test_undo_leaves_the_network_as_it_was(
    first: list[tuple[int, int, float]], trial: list[tuple[int, int, float]]
) -> None:
    network, untouched = network_of(), network_of()
    for number, (later, earlier, gap_s) in enumerate(first):
        network.after(later, earlier, gap_s, number)
        untouched.after(later, earlier, gap_s, number)
    mark = network.mark()
    for number, (later, earlier, gap_s) in enumerate(trial):
        network.after(later, earlier, gap_s, 100 + number)
    network.undo(mark)
    for event in range(EVENTS + 1):
        assert network.earliest_s(event) == untouched.earliest_s(event)
        assert network.latest_s(event) == untouched.latest_s(event)
    for number, (later, earlier, gap_s) in enumerate(trial):
        again = network.after(later, earlier, gap_s, 100 + number)
        assert (again is None) == (untouched.after(later, earlier, gap_s, 100 + number) is None)


@given(edges)
@settings(deadline=None)
def test_constraints_named_in_a_conflict_cannot_hold_together(
    all_edges: list[tuple[int, int, float]],
) -> None:
    network = network_of()
    for number, (later, earlier, gap_s) in enumerate(all_edges):
        conflict = network.after(later, earlier, gap_s, number)
        if conflict is not None:
            assert number in conflict.reasons
            assert conflict.excess_s > 0
            assert plain_earliest([all_edges[reason] for reason in conflict.reasons]) is None


def test_slack_says_how_late_an_event_may_be() -> None:
    network = network_of(2)
    assert network.not_before(1, 5.0, 0) is None
    assert network.after(2, 1, 10.0, 1) is None
    assert network.after(ORIGIN, 2, -18.0, 2) is None
    assert network.slack_s(1) == 3.0
    assert network.after(1, 2, -12.0, 3) is None
    assert network.slack_s(2) == 3.0


def test_way_that_does_not_exist_is_a_conflict_by_itself() -> None:
    network = network_of(2)
    conflict = network.after(2, 1, inf, 7)
    assert conflict is not None
    assert conflict.reasons == (7,)
    assert network.earliest_s(2) == 0.0
