"""Cells of a floor: how far they are from things, and the ways through them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.maps.building.floor_grid import CELL_M, HALF_M, FloorGrid, Point, sampled

NO_WALLS = np.zeros((0, 4))
near = st.floats(-HALF_M / 2, HALF_M / 2)
points = st.tuples(near, near)


@given(st.lists(points, min_size=1, max_size=6))
def test_a_way_is_sampled_from_its_first_to_its_last_point(way: list[Point]) -> None:
    found = sampled(way)
    assert found[0] == pytest.approx(way[0])
    assert found[-1] == pytest.approx(way[-1])
    assert np.hypot(*np.diff(found, axis=0).T).max() <= CELL_M + 1e-9


@given(points, st.tuples(near, near, near, near))
def test_cells_are_as_far_from_a_wall_as_they_are(
    at: Point, wall: tuple[float, float, float, float]
) -> None:
    away_m = FloorGrid((0.0, 0.0)).away_from_segments(np.array([wall]))
    nearest_m = min(math.dist(at, each) for each in sampled([wall[:2], wall[2:]], 0.01).tolist())
    assert FloorGrid((0.0, 0.0)).at(away_m, at) == pytest.approx(nearest_m, abs=2 * CELL_M)


def test_what_is_outside_is_near_to_nothing() -> None:
    grid = FloorGrid((5.0, 5.0))
    assert np.isinf(grid.away_from_segments(np.array([[90.0, 0.0, 90.0, 9.0]]))).all()
    assert np.isinf(grid.away_from_segments(NO_WALLS)).all()


def test_a_way_leads_round_a_wall_and_only_through_what_is_free() -> None:
    grid = FloorGrid((0.0, 0.0))
    free = grid.away_from_segments(np.array([[1.0, -3.0, 1.0, 2.0]])) > 0.3
    reach = grid.reach((0.0, 0.0), free)
    goal = round((HALF_M + 0.0) / CELL_M), round((HALF_M + 2.0) / CELL_M)
    way = grid.way(reach, goal)
    assert way[-1] == pytest.approx((2.0, 0.0))
    assert max(y for _, y in way) >= 2.3
    assert reach.metres[goal] > 4.0
    assert all(grid.at(free, each) for each in way)


def test_where_no_way_leads_nobody_gets() -> None:
    grid = FloorGrid((0.0, 0.0))
    box = [(-1, -1, 1, -1), (1, -1, 1, 1), (1, 1, -1, 1), (-1, 1, -1, -1)]
    free = grid.away_from_segments(np.array(box, np.float64)) > 0.1
    reach = grid.reach((0.0, 0.0), free)
    assert math.isinf(grid.at(reach.metres, (3.0, 0.0)))
    assert grid.at(reach.metres, (0.5, 0.0)) == pytest.approx(0.5)
