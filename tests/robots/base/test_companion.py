"""What a base makes of where it sees the person whom it leads."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.base.body import BasePose
from mend.robots.base.companion import (
    CAUGHT_UP_M,
    FALLS_BEHIND_M,
    GLIMPSE_S,
    Company,
    NoCompanion,
    Sighting,
)

STEP_S = 0.1


class Shown(NoCompanion):
    """Sees what a test shows it."""

    def __init__(self) -> None:
        self.seen: Sighting | None = None
        self.time_s = 0.0

    def sighting(self) -> Sighting | None:
        return self.seen

    def company(self) -> Company:
        return Company(self, lambda: self.time_s)

    def show(self, away_m: float | None) -> None:
        self.time_s += STEP_S
        self.seen = None if away_m is None else Sighting(away_m, math.pi)


@pytest.mark.parametrize(
    ("bearing_rad", "told"),
    [
        (0.1, "1.5 m ahead of me"),
        (-3.0, "1.5 m behind me"),
        (1.6, "1.5 m to my left"),
        (-1.6, "1.5 m to my right"),
    ],
)
def test_a_sighting_is_told_in_words(bearing_rad: float, told: str) -> None:
    assert Sighting(1.5, bearing_rad).told == told


def test_who_fell_behind_has_to_catch_up_before_it_goes_on() -> None:
    shown = Shown()
    company = shown.company()
    told = []
    for away_m in (2.5, 1.9, 2.9, 3.1, 2.5, 2.1, 1.9):
        shown.show(away_m)
        told.append(company.keeps_up())
    assert told == [False, True, True, False, False, False, True]


def test_who_is_out_of_sight_for_a_moment_only_still_follows() -> None:
    shown = Shown()
    company = shown.company()
    shown.show(1.5)
    assert company.keeps_up()
    moments = 0
    while True:
        shown.show(None)
        if not company.keeps_up():
            break
        moments += 1
    assert moments == pytest.approx(GLIMPSE_S / STEP_S, abs=1.0)
    assert company.last == Sighting(1.5, math.pi)


def test_nobody_has_been_seen_once_it_starts_anew() -> None:
    shown = Shown()
    company = shown.company()
    shown.show(1.5)
    assert company.keeps_up()
    company.start_anew()
    shown.show(None)
    assert not company.keeps_up()
    assert company.last is None


@pytest.mark.parametrize(("away_m", "so"), [(1.0, True), (1.5, False), (None, False)])
def test_where_somebody_is_follows_from_where_the_base_is(away_m: float | None, so: bool) -> None:
    shown = Shown()
    shown.show(away_m)
    here, stop = BasePose(2.0, 1.0, math.pi / 2), BasePose(2.0, 0.0, 0.0)
    assert shown.company().is_at(stop, 0.4, here) is so


@given(st.lists(st.none() | st.floats(0.0, 8.0), max_size=60))
def test_it_never_goes_on_for_longer_than_a_glimpse_without_who_follows(
    seen: list[float | None],
) -> None:
    shown = Shown()
    company = shown.company()
    beside_s, ever_near = -math.inf, False
    for away_m in seen:
        shown.show(away_m)
        if away_m is not None and away_m <= FALLS_BEHIND_M:
            beside_s = shown.time_s
        ever_near |= away_m is not None and away_m <= CAUGHT_UP_M
        if company.keeps_up():
            assert ever_near
            assert away_m is None or away_m <= FALLS_BEHIND_M
            assert shown.time_s - beside_s <= GLIMPSE_S + 1e-9
