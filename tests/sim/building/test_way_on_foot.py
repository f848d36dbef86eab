"""People get round what stands in their way, and nowhere else."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.maps.building.clearance import clearance_m
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.way_on_foot import may_walk, way_on_foot

NOTHING = np.zeros((0, 4))
WALL = np.array([[1.0, -2.0, 1.0, 2.0]])
ROOM = np.array(
    [[-1.0, -1.0, 1.0, -1.0], [1.0, -1.0, 1.0, 1.0], [1.0, 1.0, -1.0, 1.0], [-1.0, 1.0, -1.0, -1.0]]
)
near = st.floats(-4.0, 4.0)
walls = st.lists(st.tuples(near, near, near, near), max_size=5)


def test_the_way_is_straight_where_nothing_stands() -> None:
    assert way_on_foot((0.0, 0.0), (3.0, 0.0), NOTHING) == [pytest.approx((3.0, 0.0))]
    assert may_walk((0.0, 0.0), (3.0, 0.0), NOTHING)


def test_a_wall_is_walked_round() -> None:
    assert not may_walk((0.0, 0.0), (2.0, 0.0), WALL)
    way = [(0.0, 0.0), *way_on_foot((0.0, 0.0), (2.0, 0.0), WALL)]
    assert len(way) > 2
    assert all(may_walk(a, b, WALL) for a, b in pairwise(way))


def test_nobody_leaves_a_room_without_a_door() -> None:
    assert way_on_foot((0.0, 0.0), (3.0, 0.0), ROOM) == []
    assert way_on_foot((0.0, 0.0), (30.0, 0.0), NOTHING) == []


@given(walls, st.tuples(near, near))
def test_a_way_keeps_off_walls_and_ends_at_its_goal(
    around: list[tuple[float, float, float, float]], goal: tuple[float, float]
) -> None:
    segments = np.array(around, np.float64).reshape(-1, 4)
    way = way_on_foot((0.0, 0.0), goal, segments)
    if not way:
        return
    assert math.dist(way[-1], goal) < 0.1
    # The first leg begins where somebody stands, however near to a wall.
    for a, b in pairwise(way):
        assert clearance_m(a, b, segments) > RADIUS_M - 0.05
