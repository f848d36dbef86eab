"""Ways as polylines."""

import numpy as np
import pytest

from mend.robots.base.motion.polyline import Polyline

CORNER = Polyline([(0.0, 0.0), (2.0, 0.0), (2.0, 3.0)])


def test_it_has_a_length_and_points_along_it() -> None:
    assert CORNER.length_m == 5.0
    assert CORNER.end == (2.0, 3.0)
    along = CORNER.points_at(np.array([1.0, 2.0, 4.0, 9.0]))
    assert along.tolist() == [[1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [2.0, 3.0]]


def test_the_nearest_point_is_looked_for_on_a_stretch() -> None:
    assert CORNER.nearest_m(1.5, 1.0, 0.0, 5.0) == pytest.approx(3.0)
    assert CORNER.nearest_m(1.5, 1.0, 0.0, 2.0) == pytest.approx(1.5)
    assert CORNER.nearest_m(1.5, 1.0, 4.0, 5.0) == pytest.approx(4.0)


def test_one_point_is_a_way_too_and_points_that_repeat_do_no_harm() -> None:
    assert Polyline([(1.0, 1.0)]).length_m == 0.0
    assert Polyline([(1.0, 1.0)]).nearest_m(5.0, 5.0, 0.0, 0.0) == 0.0
    repeated = Polyline([(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 0.0)])
    assert repeated.length_m == 1.0
    assert repeated.nearest_m(0.4, 1.0, 0.0, 1.0) == pytest.approx(0.4)


def test_no_point_is_no_way() -> None:
    with pytest.raises(ValueError, match="at least one point"):
        Polyline([])
