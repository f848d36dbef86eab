"""Which stretches of a way count as false doubt."""

import numpy as np
import pytest
from localization_doubt import Stretches, stretches
from numpy.typing import NDArray

from mend.localization.evaluation import Trace

STEPS = 301
"""Thirty metres, a step every 0.1 m."""


def trace(off_m: NDArray[np.float64], said: NDArray[np.bool_]) -> Trace:
    truth = np.zeros((STEPS, 3))
    truth[:, 0] = 0.1 * np.arange(STEPS)
    poses = truth.copy()
    poses[:, 1] = off_m
    return Trace(poses, truth, said.astype(float), said, np.zeros(STEPS), ())


def said_at(begin: int, end: int) -> NDArray[np.bool_]:
    steps = np.arange(STEPS)
    return (steps >= begin) & (steps < end)


NEVER_OFF, NEVER_SAID = np.zeros(STEPS), np.zeros(STEPS, dtype=bool)


@pytest.mark.parametrize(("end", "doubted"), [(118, 0), (130, 1)])
def test_doubt_of_more_than_two_metres_is_false_where_nobody_is_off(end: int, doubted: int) -> None:
    found = stretches(trace(NEVER_OFF, said_at(100, end)), trace(NEVER_OFF, NEVER_SAID))
    assert found == Stretches(driven=3, held=3, doubted=doubted, right=doubted)


def test_where_the_other_one_is_off_too_nothing_is_said_of_it() -> None:
    off_m = np.where(said_at(100, 200), 2.0, 0.0)
    found = stretches(trace(off_m, said_at(100, 150)), trace(off_m, NEVER_SAID))
    assert found == Stretches(driven=3, held=2)


def test_doubt_of_who_is_off_where_the_other_one_is_not_counts_as_no_right_one() -> None:
    off_m = np.where(said_at(100, 200), 2.0, 0.0)
    found = stretches(trace(off_m, said_at(100, 150)), trace(NEVER_OFF, NEVER_SAID))
    assert found == Stretches(driven=3, held=3, doubted=1)
    assert "false doubt in 1 " in str(found)
