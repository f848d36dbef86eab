"""A door that a laser sees through is open, whatever stands in it."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from mend.maps.building.cabin import CABIN_M, cabin_walls
from mend.maps.ray_cast import cast
from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.open_door import Posts, sees_through

ANGLES = np.linspace(-math.pi, math.pi, 361)
POSTS = ((-0.5, 0.0), (0.5, 0.0))
DOOR = (-0.5, 0.0, 0.5, 0.0)
WALLS = [(-3.0, 0.0, -0.5, 0.0), (0.5, 0.0, 3.0, 0.0), (-3.0, 4.0, 3.0, 4.0)]


def scan(here: BasePose, *others: tuple[float, ...], noise_m: float = 0.0) -> RangeScan:
    walls = np.array([*WALLS, *others])
    ranges, _ = cast(walls, here.x, here.y, ANGLES + here.yaw, 10.0)
    off = np.random.default_rng(1).normal(0.0, noise_m, len(ANGLES))
    return RangeScan(np.where(ranges < 10.0, ranges + off, math.inf), ANGLES, 0.0)


def robot(x: float, y: float, radius_m: float = 0.25) -> list[tuple[float, ...]]:
    turns = np.linspace(0.0, math.tau, 17)
    ring = [(x + radius_m * math.cos(a), y + radius_m * math.sin(a)) for a in turns]
    return [(*a, *b) for a, b in itertools.pairwise(ring)]


@example(1.0, 0.375, 0.0, 0.0, 0.09375)
@given(
    st.floats(-1.0, 1.0), st.floats(0.35, 3.0), st.floats(-3.1, 3.1),
    st.floats(-0.1, 0.1), st.floats(-0.1, 0.1),
)  # fmt: skip
def test_what_is_shut_is_not_seen_through_also_where_the_map_is_a_little_off(
    x: float, away_m: float, yaw: float, off_x: float, off_y: float
) -> None:
    here = BasePose(x, -away_m, yaw)
    believed = BasePose(x + off_x, -away_m + off_y, yaw)
    assert not sees_through(scan(here, DOOR, noise_m=0.01), believed, POSTS)


@pytest.mark.parametrize(("away_m", "other_m"), [(0.3, 0.3), (0.6, 0.1), (0.35, 0.6), (1.5, 0.1)])
def test_beside_who_stands_in_a_door_one_sees_through(away_m: float, other_m: float) -> None:
    here = BasePose(0.0, -away_m, math.pi / 2)
    assert sees_through(scan(here, *robot(0.0, other_m)), here, POSTS)


def test_nothing_is_known_of_a_door_from_which_no_beam_comes_back() -> None:
    here = BasePose(0.0, -1.0, 0.0)
    nothing = RangeScan(np.full(len(ANGLES), math.inf), ANGLES, 0.0)
    assert not sees_through(nothing, here, POSTS)


def cabin(x: float, y: float, here: BasePose) -> tuple[list[tuple[float, ...]], Posts]:
    """The walls of a cabin that is shut, and from side to side of it, right across."""
    away_m = math.hypot(x - here.x, y - here.y)
    off = CABIN_M * (here.y - y) / away_m, CABIN_M * (x - here.x) / away_m
    walls = [tuple(each) for each in cabin_walls((x, y)).tolist()]
    return walls, ((x - off[0], y - off[1]), (x + off[0], y + off[1]))


@pytest.mark.parametrize("away_m", [0.9, 1.2, 2.0])
def test_a_cabin_is_not_seen_into_that_is_shut_and_is_beside_who_stands_in_it(
    away_m: float,
) -> None:
    here = BasePose(0.2, 1.0 - away_m, 0.3)
    walls, posts = cabin(0.2, 1.0, here)
    assert not sees_through(scan(here, *walls, noise_m=0.01), here, posts)
    assert sees_through(scan(here, *robot(0.2, 1.0)), here, posts)
    assert sees_through(scan(here, *robot(0.4, 0.8, 0.2)), here, posts)
