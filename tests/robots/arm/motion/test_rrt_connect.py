"""Ways around things: what is found is free all along, and what has no way is not found."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.robots.arm.motion.rrt_connect import connect

LOW, HIGH = np.array([-3.0, -3.0]), np.array([3.0, 3.0])
START, GOAL = np.array([-1.0, 0.0]), np.array([1.0, 0.0])


def wall(gap_at: float, gap: float, spared: float = 0.0):
    """A wall at x = 0, 0.3 thick, with a gap in it, each side of it drawn in by `spared`."""

    def is_free(at) -> bool:
        return abs(at[0]) > 0.15 - spared or abs(at[1] - gap_at) < gap / 2 + spared

    return is_free


@settings(deadline=None, max_examples=30)
@given(gap_at=st.floats(-0.6, 0.6), seed=st.integers(0, 1000))
def test_a_way_leads_through_a_gap_and_is_free_all_along(gap_at: float, seed: int) -> None:
    is_free = wall(gap_at, 0.5)
    way = connect(START, GOAL, LOW, HIGH, is_free, np.random.default_rng(seed))
    assert way is not None
    assert np.array_equal(way[0], START)
    assert np.array_equal(way[-1], GOAL)
    # Ways are looked at every 0.06.
    about_free = wall(gap_at, 0.5, spared=0.06)
    for one, other in pairwise(way):
        assert all(about_free(one + (other - one) * part) for part in np.linspace(0.0, 1.0, 50))


def test_where_nothing_is_on_the_way_it_is_straight() -> None:
    way = connect(START, GOAL, LOW, HIGH, lambda _: True, np.random.default_rng(0))
    assert way is not None
    assert len(way) == 2


@pytest.mark.parametrize("is_free", [lambda at: abs(at[0]) > 0.15, lambda at: at[0] < 0.9])
def test_what_cannot_be_reached_is_not(is_free) -> None:
    assert connect(START, GOAL, LOW, HIGH, is_free, np.random.default_rng(0)) is None


def test_the_same_generator_finds_the_same_way() -> None:
    one, other = (
        connect(START, GOAL, LOW, HIGH, wall(0.5, 0.4), np.random.default_rng(7)) for _ in range(2)
    )
    assert one is not None
    assert other is not None
    assert np.array_equal(np.array(one), np.array(other))
