"""A base knows how far it has driven, and how long its way was barred meanwhile."""

import math
from itertools import pairwise

import pytest
from cart_bench import CartBench
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.base.body import BasePose
from mend.robots.base.driven_way import DrivenWay
from mend.robots.link.messages import Driven, IssueDetected, StepStarted
from mend.tasks.intervention import Act, Intervention


def driven(bench: CartBench) -> Driven:
    told = bench.robot.driven()
    assert told is not None
    return told


def test_a_way_that_is_driven_is_as_long_as_it_is() -> None:
    bench = CartBench()
    assert driven(bench) == Driven(way_m=0.0, barred_s=0.0)
    bench.start(place="far")
    bench.run()
    assert driven(bench).way_m == pytest.approx(6.0, abs=0.3)
    assert driven(bench).barred_s == 0.0
    (step,) = bench.of(StepStarted)
    assert step.phase == "travel"


def test_standing_before_what_bars_the_way_is_counted_and_standing_for_an_answer_is_not() -> None:
    bench = CartBench()
    bench.start(place="near")
    bench.run_for(0.5)
    bench.world.intervene(Intervention(act=Act.BLOCK))
    bench.run_until(IssueDetected)
    before = driven(bench)
    assert 4.0 <= before.barred_s <= 6.0
    bench.run_for(30.0)
    assert driven(bench).barred_s == before.barred_s


@given(st.lists(st.tuples(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0)), min_size=1))
def test_a_way_is_as_long_as_its_parts_from_where_wheels_were_first_noted(
    points: list[tuple[float, float]],
) -> None:
    way = DrivenWay()
    for x, y in points:
        way.note(BasePose(x, y, 0.0))
    last = BasePose(*points[-1], 0.0)
    parts = sum(math.dist(a, b) for a, b in pairwise(points))
    assert math.isclose(way.so_far(last).way_m, parts, abs_tol=1e-6)
    beyond = BasePose(last.x + 3.0, last.y + 4.0, 0.0)
    assert math.isclose(way.so_far(beyond).way_m, parts + 5.0, abs_tol=1e-6)
    assert math.isclose(way.so_far(last).way_m, parts, abs_tol=1e-6)
