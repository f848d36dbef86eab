"""Headway: who only moves comes no nearer."""

import math

from mend.robots.base.motion.headway import Headway


def noted(lefts_m: list[float], turns_rad: list[float | None] | None = None) -> float:
    headway = Headway(turn_rad_s=math.tau)
    for left_m, turn_rad in zip(lefts_m, turns_rad or [None] * len(lefts_m), strict=True):
        headway.note(left_m, turn_rad, 1.0)
    return headway.stalled_s


def test_who_comes_nearer_makes_headway() -> None:
    assert noted([5.0, 4.5, 4.0, 3.5]) == 0.0


def test_who_goes_to_and_fro_makes_none() -> None:
    assert noted([5.0, 4.0, 4.5, 4.0, 4.5, 4.0]) == 3.0, "one second is for a turn"


def test_who_turns_at_the_end_does() -> None:
    assert noted([0.01] * 5, [2.0, 1.5, 1.0, 0.5, 0.2]) == 0.0
    assert noted([0.01] * 5, [2.0, 2.0, 2.0, 2.0, 2.0]) == 3.0
