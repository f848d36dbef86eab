"""A base gets round corners of its way that are so sharp that it cuts them."""

import math

import pytest
from cart_bench import CartBench
from courtyard.cart import PERIOD_S

from mend.robots.base.body import BasePose
from mend.robots.base.ways import StraightWays
from mend.robots.link.messages import Finished


class Hairpin(StraightWays):
    """Up, and back down beside it."""

    def __init__(self, apart_m: float) -> None:
        self._apart_m = apart_m

    def path(self, here: BasePose, to: BasePose, *_: object) -> list[tuple[float, float]]:  # noqa: ARG002
        return [(0.0, 7.0), (self._apart_m, 0.0), (to.x, to.y)]


@pytest.mark.parametrize("apart_m", [1.0, 2.0, 3.0])
def test_a_hairpin_is_driven_to_its_end(apart_m: float) -> None:
    bench = CartBench(ways=Hairpin(apart_m))
    bench.start(place="far")
    highest_m = 0.0
    while bench.robot.advance(PERIOD_S):
        highest_m = max(highest_m, bench.cart.pose().y)
    assert bench.of(Finished)
    assert highest_m > 5.0
    assert math.hypot(bench.cart.pose().x - 6.0, bench.cart.pose().y) < 0.1
