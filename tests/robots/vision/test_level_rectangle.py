"""A turned rectangle: its corners, and what is in it."""

import math

import numpy as np
import pytest

from mend.robots.vision.level_rectangle import Rectangle

TURNED = Rectangle(1.0, 2.0, math.pi / 2, (0.4, 0.2))


def test_corners_are_turned_with_it_and_go_around_counter_clockwise() -> None:
    assert TURNED.corners() == pytest.approx(
        np.array([[1.1, 1.8], [1.1, 2.2], [0.9, 2.2], [0.9, 1.8]])
    )


def test_a_point_by_its_own_axes_is_found_there_again() -> None:
    assert TURNED.point(0.1, 0.05) == pytest.approx((0.95, 2.1))
    assert TURNED.local(np.array([TURNED.point(0.1, 0.05)])) == pytest.approx(
        np.array([[0.1, 0.05]])
    )


def test_it_holds_what_is_within_its_own_extents_and_a_margin() -> None:
    points = np.array([TURNED.point(0.19, 0.09), TURNED.point(0.21, 0.0), TURNED.point(0.0, 0.12)])
    assert TURNED.holds(points, 0.0).tolist() == [True, False, False]
    assert TURNED.holds(points, 0.015).tolist() == [True, True, False]
