"""How far the beams see that are next to a point."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from mend.robots.base.motion.beams import measure_beside

FAR_M = 6.0
ROUND = np.linspace(-math.pi, math.pi, 9)
AHEAD = np.linspace(-math.pi / 4.0, math.pi / 4.0, 3)


def beside(
    point: tuple[float, float],
    angles: NDArray[np.float64],
    ranges_m: Sequence[float],
    pose: Sequence[float] = (0.0, 0.0, 0.0),
) -> tuple[float, float]:
    """How far a point is, and how far the beams next to it see."""
    away_m, sees_m = np.empty(1), np.empty(1)
    measure_beside(
        np.array([point]), np.array(pose), angles, np.array(ranges_m), FAR_M, away_m, sees_m
    )
    return float(away_m[0]), float(sees_m[0])


def test_it_is_what_the_beam_sees_that_sees_less() -> None:
    assert beside((2.0, 0.5), AHEAD, [9.0, 5.0, 3.0]) == (math.hypot(2.0, 0.5), 3.0)
    assert beside((2.0, -0.5), AHEAD, [9.0, 5.0, 3.0]) == (math.hypot(2.0, -0.5), 5.0)


def test_nothing_is_seen_beside_the_beams_nor_far_away() -> None:
    assert math.isnan(beside((-2.0, 0.0), AHEAD, [9.0, 5.0, 3.0])[1])
    away_m, sees_m = beside((FAR_M, 0.0), ROUND, [9.0] * 9)
    assert away_m == FAR_M
    assert math.isnan(sees_m)


@given(
    at=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    bearing=st.floats(-math.pi, math.pi),
    away_m=st.floats(0.1, FAR_M - 0.1),
)
def test_a_full_circle_sees_all_around_wherever_it_is(
    at: tuple[float, float, float], bearing: float, away_m: float
) -> None:
    ranges_m = np.arange(1.0, 10.0)
    x = at[0] + away_m * math.cos(at[2] + bearing)
    y = at[1] + away_m * math.sin(at[2] + bearing)
    found_m, sees_m = beside((x, y), ROUND, ranges_m.tolist(), at)
    assert found_m == pytest.approx(away_m)
    before = (bearing - ROUND[0]) / (ROUND[1] - ROUND[0])
    # Where a beam is in the very middle either of the two pairs may be the one beside it.
    assert sees_m in {float(ranges_m[math.floor(before + e) % 8]) for e in (-1e-6, 1e-6)}
