"""Whoever is to be met where there is no room beside the place bars the way to nobody."""

import math

import pytest
from cart_bench import PLACES, CartBench

from mend.robots.base.companion import NoCompanion, Sighting
from mend.robots.link.messages import Finished, IssueDetected
from mend.tasks.frames import Frame

PERSON_M = 0.25
START = Frame(-4.0, -3.0)
"""Where the cart stands at first."""


class Badge(NoCompanion):
    """Tells where the first visitor is, if that is whom the cart is to meet."""

    range_m = 6.0
    bench: CartBench

    def __init__(self, *, is_worn: bool) -> None:
        self._is_worn = is_worn

    def sighting(self) -> Sighting | None:
        if not self._is_worn:
            return None
        at, (x, y, _) = self.bench.cart.place, self.bench.world.visitors[0]
        return Sighting(math.hypot(x - at.x, y - at.y), math.atan2(y - at.y, x - at.x) - at.yaw)


def narrow(before_m: float, *, is_met: bool = True) -> CartBench:
    """A way with people on both sides, and one on it so far before the place."""
    badge = Badge(is_worn=is_met)
    badge.bench = bench = CartBench(companion=badge)
    sides = [(x / 3.0, y) for x in range(24) for y in (-0.9, 0.9)]
    people = [(PLACES["far"].x - before_m, 0.0), *sides]
    bench.world.visitors = [(*START.to_scene(x, y), PERSON_M) for x, y in people]
    return bench


@pytest.mark.parametrize("before_m", [0.2, 0.9, 1.5])
def test_who_is_to_be_met_is_met_where_they_bar_the_way(before_m: float) -> None:
    bench = narrow(before_m)
    bench.start("meet_person", place="far", person="Bo")
    bench.run()
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == [Finished(execution="e1")]


@pytest.mark.parametrize(("before_m", "is_met"), [(1.5, False), (4.0, True)])
def test_who_is_somebody_else_or_far_from_the_place_is_in_the_way(
    before_m: float, is_met: bool
) -> None:
    bench = narrow(before_m, is_met=is_met)
    bench.start("meet_person", place="far", person="Bo")
    assert bench.run_until(IssueDetected).issue == "blocked"
