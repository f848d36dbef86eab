"""Rays over a grid of segments: the same as the ray cast that knows of no grid."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from mend.maps.ray_cast import NOTHING, cast
from mend.maps.segment_grid import cast_rays, segment_grid

Matrix = NDArray[np.float64]


def rays(
    segments: Matrix, sensor: list[float], bearings: Matrix, max_range_m: float
) -> tuple[Matrix, NDArray[np.int64]]:
    ranges_m, seen = np.empty(len(bearings)), np.empty(len(bearings), dtype=np.int64)
    grid = segment_grid(segments)
    cast_rays(grid, np.array(sensor), bearings, max_range_m, ranges_m, seen)
    return ranges_m, seen


@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(0, 25),
    spread_m=st.floats(0.1, 60.0),
    max_range_m=st.floats(0.5, 40.0),
)
@settings(max_examples=60, deadline=None)
def test_it_sees_what_the_sweep_sees(
    seed: int, count: int, spread_m: float, max_range_m: float
) -> None:
    generator = np.random.default_rng(seed)
    segments = generator.uniform(-spread_m, spread_m, (count, 4))
    bearings = generator.uniform(-10.0, 10.0, 30)
    x, y, heading = generator.uniform(-1.5 * spread_m, 1.5 * spread_m, 3)
    ranges_m, seen = rays(segments, [x, y, heading], bearings, max_range_m)
    expected_m, which = cast(segments, x, y, bearings + heading, max_range_m)
    assert ranges_m == pytest.approx(expected_m, abs=1e-6)
    assert seen.tolist() == which.tolist()


@given(x=st.integers(-6, 6), y=st.integers(-6, 6), eighth=st.integers(0, 7), far=st.integers(1, 8))
def test_rays_and_walls_along_the_lines_of_the_grid_are_seen(
    x: int, y: int, eighth: int, far: int
) -> None:
    """Everything on multiples of the cells' width, where rounding would let rays slip through."""
    angle = eighth * np.pi / 4.0
    middle = np.array([x, y]) / 2.0 + far / 2.0 * np.rint([np.cos(angle), np.sin(angle)])
    across = np.array([-np.sin(angle), np.cos(angle)])
    wall = np.array([[*(middle - across), *(middle + across)]])
    ranges_m, seen = rays(wall, [x / 2.0, y / 2.0, angle], np.zeros(1), 20.0)
    assert seen.tolist() == [0]
    assert ranges_m[0] == pytest.approx(float(np.hypot(*(middle - np.array([x, y]) / 2.0))))


def test_no_ray_slips_through_a_shared_corner() -> None:
    around = np.linspace(0.0, 2.0 * np.pi, 8)
    corners = 3.0 * np.column_stack((np.cos(around), np.sin(around)))
    ring = np.hstack((corners[:-1], corners[1:]))
    _, seen = rays(ring, [0.0, 0.0, 0.0], around[:-1], 5.0)
    assert (seen != NOTHING).all()


def test_where_nothing_is_the_range_is_the_largest() -> None:
    wall = np.array([[1.0, -1.0, 1.0, 1.0]])
    for sensor in ([0.0, 0.0, np.pi], [-30.0, 0.0, 0.0], [0.9, 40.0, 0.3]):
        ranges_m, seen = rays(wall, sensor, np.zeros(1), 7.0)
        assert ranges_m.tolist() == [7.0]
        assert seen.tolist() == [NOTHING]


def test_an_empty_map_and_no_rays_are_no_trouble() -> None:
    ranges_m, seen = rays(np.empty((0, 4)), [0.0, 0.0, 0.0], np.array([0.0, 1.0]), 3.0)
    assert ranges_m.tolist() == [3.0, 3.0]
    assert seen.tolist() == [NOTHING, NOTHING]
    assert len(rays(np.array([[1.0, 0.0, 1.0, 1.0]]), [0.0, 0.0, 0.0], np.empty(0), 3.0)[0]) == 0


def test_a_large_map_has_larger_cells() -> None:
    far = np.array([[-20_000.0, 0.0, -20_000.0, 5.0], [20_000.0, -5.0, 20_000.0, 5.0]])
    assert segment_grid(far).rows * segment_grid(far).columns < 2_000_000
    ranges_m, seen = rays(far, [19_990.0, 0.0, 0.0], np.zeros(1), 30.0)
    assert ranges_m == pytest.approx([10.0])
    assert seen.tolist() == [1]
