"""How often poses are taken: at the rate asked for, never sooner, and once more at rest."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from mend.robots.link.sampling import SHORTEST_WALL_S, PoseSampling


def test_nothing_is_due_before_somebody_asks_or_after_nobody_does() -> None:
    sampling = PoseSampling()
    assert not sampling.due(0.0, 0.0)
    assert not sampling.due_at_rest(1.0, 1.0)
    sampling.ask(20.0)
    assert sampling.due(1.0, 1.0)
    sampling.ask(0.0)
    assert not sampling.due(9.0, 9.0)
    assert not sampling.due_at_rest(9.0, 9.0)
    assert sampling.longest_slice_s(9.0) > 1e9


@given(
    rate_hz=st.floats(1.0, 100.0),
    speed=st.floats(0.1, 1000.0),
    steps=st.lists(st.floats(0.001, 0.1), min_size=1, max_size=200),
)
def test_samples_are_never_nearer_than_asked_for_in_either_clock(
    rate_hz: float, speed: float, steps: list[float]
) -> None:
    sampling = PoseSampling()
    sampling.ask(rate_hz)
    wall_s, taken = 0.0, []
    for step in steps:
        wall_s += step
        if sampling.due(wall_s * speed, wall_s):
            taken.append(wall_s)
    assert taken[0] == steps[0]
    for earlier, later in pairwise(taken):
        assert (later - earlier) * speed >= 1.0 / rate_hz - 1e-6
        assert later - earlier >= SHORTEST_WALL_S - 1e-9


def test_a_change_is_shown_although_no_time_has_passed() -> None:
    sampling = PoseSampling()
    sampling.ask(20.0)
    assert sampling.due(1.0, 1.0)
    assert not sampling.due(1.0, 2.0)
    sampling.change()
    assert sampling.due(1.0, 2.0)


def test_a_robot_that_comes_to_rest_shows_where_and_then_no_more() -> None:
    sampling = PoseSampling()
    sampling.ask(20.0)
    assert sampling.due(1.0, 1.0)
    assert sampling.due_at_rest(1.01, 1.001)
    assert not sampling.due_at_rest(1.01, 2.0)
    sampling.change()
    assert sampling.due_at_rest(1.01, 2.0)
