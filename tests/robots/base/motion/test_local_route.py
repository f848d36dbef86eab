"""The search around a base: round things, between them, and no farther than there is a way."""

import numpy as np
import pytest

from mend.robots.base.motion.local_route import NO_WAY, SPARE_M, Ends, LocalRoute, find_route

RADIUS_M = 0.3
TARGETS = np.column_stack([np.linspace(0.1, 2.5, 25), np.zeros(25)])


def route(points, longest_m: float = 10.0, before=NO_WAY) -> LocalRoute:
    ends = Ends(TARGETS, np.full(len(TARGETS), longest_m))
    return find_route((0.0, 0.0), np.asarray(points, float), ends, RADIUS_M, 1.0, before)


def wall(x: float, low: float, high: float):
    y = np.arange(low, high, 0.05)
    return np.column_stack([np.full(len(y), x), y])


def test_in_the_open_it_is_straight() -> None:
    found = route(np.zeros((0, 2)))
    assert found.reached == len(TARGETS) - 1
    assert found.carrot[0] == pytest.approx(1.0, abs=0.05)
    assert found.carrot[1] == 0.0
    assert found.cost_m == pytest.approx(2.5, abs=0.05)


def test_all_of_it_is_clear_of_things() -> None:
    points = wall(1.0, -0.4, 0.4)
    found = route(points)
    assert found.reached == len(TARGETS) - 1
    away_m = np.hypot(*(found.way[:, None] - points[None]).transpose(2, 0, 1)).min()
    assert away_m >= RADIUS_M + SPARE_M


def test_where_there_is_no_way_it_leads_to_the_last_point_before() -> None:
    found = route(wall(1.5, -5.0, 5.0))
    assert found.reached is not None
    assert TARGETS[found.reached, 0] == pytest.approx(1.5 - RADIUS_M - SPARE_M, abs=0.1)


def test_a_way_round_may_be_too_long() -> None:
    around = wall(1.5, -1.5, 1.5)
    assert route(around).reached == len(TARGETS) - 1
    found = route(around, longest_m=3.0)
    assert found.reached is not None
    assert TARGETS[found.reached, 0] < 1.5


def test_a_gap_is_passed_that_is_wide_enough() -> None:
    def through(gap_m: float) -> LocalRoute:
        return route([*wall(1.0, -5.0, -gap_m / 2), *wall(1.0, gap_m / 2, 5.0)])

    assert through(2 * RADIUS_M + 0.2).cost_m < 10.0
    assert through(2 * RADIUS_M + 0.2).reached == len(TARGETS) - 1
    assert through(2 * RADIUS_M).reached != len(TARGETS) - 1


def test_of_two_sides_that_are_alike_it_keeps_the_one_that_it_took() -> None:
    before = route(wall(1.0, -0.5, 0.6)).way
    side = np.sign(before[np.argmax(np.abs(before[:, 1])), 1])
    assert side == -1.0
    # Now the other side is a little shorter.
    again = route(wall(1.0, -0.6, 0.5), before=before).way
    assert np.sign(again[np.argmax(np.abs(again[:, 1])), 1]) == side
    anew = route(wall(1.0, -0.6, 0.5)).way
    assert np.sign(anew[np.argmax(np.abs(anew[:, 1])), 1]) == -side
