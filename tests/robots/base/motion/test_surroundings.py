"""What a base knows of its surroundings: what is seen, what is hidden, and what comes."""

import math

import numpy as np
from driven_floor import BEAMS, Floor

from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.motion.surroundings import Seen, Surroundings

WALL = (3.0, -4.0, 3.0, 4.0)
HERE = BasePose(0.0, 0.0, 0.0)


def take(surroundings: Surroundings, floor: Floor, at: BasePose, time_s: float) -> Seen:
    return surroundings.take(RangeScan(floor.ranges_m(at), BEAMS, time_s), at, time_s)


def knows_of(seen: Seen, x: float, y: float) -> bool:
    return bool(np.any(np.hypot(*(seen.points - np.array([x, y])).T) < 0.1))


def test_what_it_sees_is_where_it_is_however_the_base_stands() -> None:
    at = BasePose(1.0, 1.0, 2.0)
    seen = take(Surroundings(), Floor([WALL]), at, 0.0)
    assert np.allclose(seen.points[:, 0], 3.0)


def test_a_wall_that_is_seen_at_a_grazing_angle_has_no_holes() -> None:
    seen = take(Surroundings(), Floor([(-1.0, 0.3, 6.0, 0.3)]), HERE, 0.0)
    assert all(knows_of(seen, x, 0.3) for x in np.arange(0.0, 5.0, 0.1))


def test_what_is_open_beside_something_is_not_closed() -> None:
    post = (1.5, 0.0, 0.2)
    seen = take(Surroundings(), Floor([WALL], [post]), HERE, 0.0)
    edge = math.asin(0.2 / 1.5)
    beside = [(d * math.cos(edge), d * math.sin(edge) + 0.05) for d in np.arange(1.8, 2.8, 0.1)]
    assert not any(knows_of(seen, *each) for each in beside)


def test_an_older_scan_is_of_where_the_base_was_then() -> None:
    surroundings, floor = Surroundings(), Floor([WALL])
    scan = RangeScan(floor.ranges_m(HERE), BEAMS, 0.0)
    surroundings.take(scan, HERE, 0.0)
    late = RangeScan(scan.ranges_m, BEAMS, 0.0)
    seen = surroundings.take(late, BasePose(0.5, 0.0, 0.1), 0.1)
    assert np.allclose(seen.points[:, 0], 3.0)


def test_what_something_hides_is_remembered_for_a_while() -> None:
    surroundings = Surroundings()
    post = (2.0, 0.0, 0.1)
    take(surroundings, Floor([WALL], [post]), HERE, 0.0)
    hiding = Floor([WALL], [post, (0.8, 0.0, 0.2)])
    assert knows_of(take(surroundings, hiding, HERE, 0.1), 1.9, 0.0)
    assert knows_of(take(surroundings, hiding, HERE, 10.0), 1.9, 0.0)
    assert not knows_of(take(surroundings, hiding, HERE, 30.0), 1.9, 0.0)


def test_what_is_seen_to_be_gone_is_forgotten() -> None:
    surroundings = Surroundings()
    take(surroundings, Floor([WALL], [(2.0, 0.0, 0.1)]), HERE, 0.0)
    take(surroundings, Floor([WALL], [(2.0, 0.0, 0.1), (0.8, 0.0, 0.2)]), HERE, 0.1)
    assert not knows_of(take(surroundings, Floor([WALL]), HERE, 0.2), 1.9, 0.0)


def test_what_lies_beside_the_field_of_view_is_remembered() -> None:
    surroundings, floor = Surroundings(), Floor([], [(0.0, 1.0, 0.2)])
    ahead = np.abs(BEAMS) < 1.8
    for number, yaw in enumerate((0.0, -math.pi / 2)):
        at = BasePose(0.0, 0.0, yaw)
        scan = RangeScan(floor.ranges_m(at)[ahead], BEAMS[ahead], 0.1 * number)
        seen = surroundings.take(scan, at, 0.1 * number)
    assert knows_of(seen, 0.0, 0.8)


def test_who_walks_comes_and_what_stands_does_not_however_the_base_moves() -> None:
    surroundings = Surroundings()
    for number in range(12):
        time_s = 0.1 * number
        floor = Floor([WALL], [(2.0, 1.0 - time_s, 0.2), (1.0, 2.0, 0.2)])
        at = BasePose(0.3 * time_s, 0.2 * time_s, 0.5 * time_s)
        seen = take(surroundings, floor, at, time_s)
    comes = seen.points[seen.speeds_m_s > 0.0]
    assert len(comes) > 0
    assert np.all(np.hypot(comes[:, 0] - 2.0, comes[:, 1] - (1.0 - time_s)) < 0.21)
    fastest = float(seen.speeds_m_s.max())
    assert 0.5 < fastest < 1.5
