"""The room of a base on an arc: what dense samples of the arc say."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.robots.base.motion.arcs import measure_room

AMPLE_M = 0.5


def sampled_room_m(points, needs_m, velocity, time_s) -> float:
    """By a thousand poses on the arc."""
    forward, left, turn = velocity
    times_s = np.linspace(0.0, time_s, 1001)
    half = turn * times_s / 2.0
    chord_s = times_s * np.sinc(half / np.pi)
    x = chord_s * (np.cos(half) * forward - np.sin(half) * left)
    y = chord_s * (np.sin(half) * forward + np.cos(half) * left)
    away_m = np.hypot(points[:, :1] - x, points[:, 1:] - y).min(axis=1)
    return float(min(AMPLE_M, (away_m - needs_m).min()))


@settings(max_examples=sample(66, 200), deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    forward=st.floats(-1.0, 1.0),
    left=st.floats(-1.0, 1.0),
    turn=st.floats(-3.0, 3.0),
    time_s=st.floats(0.05, 4.0),
)
def test_it_is_that_of_dense_samples(seed, forward, left, turn, time_s) -> None:
    rng = np.random.default_rng(seed)
    points, needs_m = rng.uniform(-3.0, 3.0, (20, 2)), rng.uniform(0.0, 0.4, 20)
    velocity = (forward, left, turn)
    room_m = np.full(1, AMPLE_M)
    measure_room(points, needs_m, np.array([velocity]), np.array([time_s]), room_m)
    assert abs(room_m[0] - sampled_room_m(points, needs_m, velocity, time_s)) < 0.005


def test_who_stands_has_the_room_that_there_is() -> None:
    room_m = np.full(1, AMPLE_M)
    points = np.array([[0.0, 0.6], [2.0, 0.0]])
    measure_room(points, np.full(2, 0.4), np.zeros((1, 3)), np.array([1.0]), room_m)
    assert abs(room_m[0] - 0.2) < 1e-9
