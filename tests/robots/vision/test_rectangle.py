"""Where a surface may reach, by what is seen of it."""

import math

import pytest

from robots.vision.level_rectangle import Rectangle
from robots.vision.rectangle import Fitted

YAWS = (0.0, 0.4, math.pi / 2, -1.2)


@pytest.mark.parametrize("yaw", YAWS)
def test_an_outline_is_the_rectangle_where_all_sides_are_seen(yaw: float) -> None:
    fitted = Fitted(Rectangle(0.5, -0.2, yaw, (0.10, 0.04)), (True,) * 4, 0.1, 1.0)
    outline = fitted.outline(hidden_m=0.1)
    assert outline.area == pytest.approx(0.10 * 0.04)
    assert outline.centroid.coords[0] == pytest.approx((0.5, -0.2))


@pytest.mark.parametrize("yaw", YAWS)
@pytest.mark.parametrize("side", range(4))
def test_beyond_a_side_that_is_not_seen_it_may_go_on(yaw: float, side: int) -> None:
    seen = tuple(number != side for number in range(4))
    fitted = Fitted(Rectangle(0.5, -0.2, yaw, (0.10, 0.04)), seen, 0.1, 1.0)
    outline = fitted.outline(hidden_m=0.06)
    along, sign = (0.0, math.pi / 2)[side // 2], (-1, 1)[side % 2]
    shift = [sign * 0.03 * each for each in (math.cos(yaw + along), math.sin(yaw + along))]
    assert outline.centroid.coords[0] == pytest.approx((0.5 + shift[0], -0.2 + shift[1]))
    assert outline.area == pytest.approx(0.16 * 0.04 if side < 2 else 0.10 * 0.10)
