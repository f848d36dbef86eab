"""How long a drive takes: what its limits allow, and what follows from the way."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.base.body import DriveLimits
from mend.robots.base.drive_time import ROUNDS_BY_M, ROUNDS_FROM_M, drive_s, length_m

LIMITS = DriveLimits(1.0, 1.0, 1.5, 2.0, sideways=True)
PERIOD_S = 0.05

coordinates = st.floats(-30.0, 30.0)
ways = st.lists(st.tuples(coordinates, coordinates), min_size=2, max_size=6)
angles = st.floats(-math.pi, math.pi)


@pytest.mark.parametrize(("metres", "seconds"), [(0.25, 1.0), (1.0, 2.0), (9.0, 10.0)])
def test_straight_on_it_speeds_up_goes_and_brakes(metres: float, seconds: float) -> None:
    straight = drive_s([(0.0, 0.0), (metres, 0.0)], 0.0, 0.0, LIMITS, 1e-9)
    assert straight == pytest.approx(seconds, abs=1e-6)


def test_points_on_a_straight_way_change_nothing() -> None:
    one = drive_s([(0.0, 0.0), (9.0, 0.0)], 0.0, 0.0, LIMITS, PERIOD_S)
    many = drive_s([(float(x), 0.0) for x in (0, 2, 2, 5, 9)], 0.0, 0.0, LIMITS, PERIOD_S)
    assert many == pytest.approx(one)


def straight_s(metres: float) -> float:
    return drive_s([(0.0, 0.0), (metres, 0.0)], 0.0, 0.0, LIMITS, PERIOD_S)


def test_a_right_angle_with_room_is_cut() -> None:
    way = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]
    assert drive_s(way, 0.0, math.pi / 2.0, LIMITS, PERIOD_S) == pytest.approx(
        straight_s(20.0 - (2.0 - math.pi / 2.0) * ROUNDS_FROM_M), abs=0.01
    )


def test_steps_that_are_short_are_gone_past_straight() -> None:
    steps = [(0.0, 0.0), *((0.5 * (n // 2), 0.5 * ((n + 1) // 2)) for n in range(1, 40))]
    lasts_s = drive_s(steps, math.pi / 4.0, math.pi / 4.0, LIMITS, PERIOD_S)
    assert lasts_s == pytest.approx(straight_s(math.dist(steps[0], steps[-1])), rel=0.05)


def test_who_has_to_go_back_stops() -> None:
    back = [(0.0, 0.0), (10.0, 0.0), (0.0, 0.01)]
    lasts_s = drive_s(back, 0.0, math.pi, LIMITS, PERIOD_S)
    assert lasts_s == pytest.approx(2.0 * straight_s(10.0 - ROUNDS_BY_M), abs=0.5)


def test_who_has_to_turn_at_the_end_is_longer_at_it() -> None:
    way = [(0.0, 0.0), (5.0, 0.0)]
    times_s = [drive_s(way, 0.0, turn, LIMITS, PERIOD_S) for turn in (0.0, 1.0, 2.0, math.pi)]
    assert times_s == sorted(times_s)
    # A whole turn about takes pi / 1.5 + 1.5 / 2 seconds, of which some are driven.
    assert 1.0 < times_s[-1] - times_s[0] < math.pi / 1.5 + 0.75


def test_turning_on_the_spot_takes_its_time_and_standing_none() -> None:
    here = [(1.0, 1.0), (1.0, 1.0)]
    assert drive_s(here, 0.0, math.pi, LIMITS, PERIOD_S) == pytest.approx(math.pi / 1.5 + 0.75)
    assert drive_s([], 1.0, 1.0, LIMITS, PERIOD_S) == 0.0


@given(way=ways, starts=angles, ends=angles)
def test_no_drive_is_quicker_than_the_straight_line_or_slower_than_stopping_at_each_bend(
    way: list[tuple[float, float]], starts: float, ends: float
) -> None:
    lasts_s = drive_s(way, starts, ends, LIMITS, PERIOD_S)
    assert lasts_s >= math.dist(way[0], way[-1]) / LIMITS.speed_m_s - 1e-6
    stops_s = sum(1.0 for _ in way) * LIMITS.speed_m_s / LIMITS.acceleration_m_s2
    turns_s = len(way) * (math.pi / LIMITS.turn_rad_s + 0.75)
    assert lasts_s <= length_m(way) / LIMITS.speed_m_s + stops_s + turns_s + 1.0


@given(way=ways, starts=angles, ends=angles)
def test_who_is_faster_is_there_sooner(
    way: list[tuple[float, float]], starts: float, ends: float
) -> None:
    fast = DriveLimits(2.0, 2.0, 3.0, 4.0, sideways=True)
    slow_s = drive_s(way, starts, ends, LIMITS, PERIOD_S)
    assert drive_s(way, starts, ends, fast, PERIOD_S) <= slow_s + 0.05
