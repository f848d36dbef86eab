"""The ends of walls are as thick as walls are; joints of walls are none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.maps.building.wall_ends import wall_ends
from mend.maps.ray_cast import cast

ROOM = np.array([[0, 0, 4, 0], [4, 0, 4, 3], [4, 3, 0, 3], [0, 3, 0, 0]], np.float64)


def test_a_wall_alone_ends_twice() -> None:
    assert wall_ends(np.array([[1.0, 1.0, 3.0, 1.0]]), 0.1) == pytest.approx(
        np.array([[1.0, 0.95, 1.0, 1.05], [3.0, 0.95, 3.0, 1.05]])
    )


def test_a_closed_room_has_no_ends_and_a_door_in_it_two() -> None:
    assert len(wall_ends(ROOM, 0.1)) == 0
    with_door = np.vstack([ROOM[1:], [[0, 0, 1.5, 0], [2.5, 0, 4, 0]]])
    ends = wall_ends(with_door, 0.1)
    assert sorted(ends[:, 0]) == [1.5, 2.5]


def test_a_wall_that_ends_at_another_is_joined_there() -> None:
    middle = np.vstack([ROOM, [[2.0, 0.0, 2.0, 1.0]]])
    assert wall_ends(middle, 0.1)[:, 1] == pytest.approx([1.0])


def test_nothing_has_no_ends() -> None:
    assert wall_ends(np.zeros((0, 4)), 0.1).shape == (0, 4)
    assert wall_ends(np.array([[1.0, 1.0, 1.0, 1.0]]), 0.1).shape == (0, 4)


@given(st.floats(-3.14, 3.14), st.floats(0.3, 3.0))
def test_who_stands_in_line_with_a_wall_sees_where_it_ends(yaw: float, away_m: float) -> None:
    along = np.array([np.cos(yaw), np.sin(yaw)])
    wall = np.concatenate([away_m * along, (away_m + 2.0) * along])[None]
    segments = np.vstack([wall, wall_ends(wall, 0.08)])
    ranges, _ = cast(segments, 0.0, 0.0, yaw + np.radians([-0.5, 0.0, 0.5]), 10.0)
    assert ranges.min() == pytest.approx(away_m, abs=0.01)
