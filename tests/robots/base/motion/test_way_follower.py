"""A base on its way: it gets round things and through doors, touches nothing, and says when not."""

import math
from typing import Any

import numpy as np
import pytest
from driven_floor import (
    FORWARD,
    PERIOD_S,
    SIDEWAYS,
    Drive,
    Driven,
    Floor,
    drawn_corridor,
    has_way,
)
from sampled import sample

from mend.robots.base.body import STANDING, BasePose, DriveLimits
from mend.robots.base.motion import way_follower
from mend.robots.base.motion.local_route import LocalRoute, find_route
from mend.robots.base.motion.surroundings import Seen
from mend.robots.base.motion.way_follower import WayFollower

START = BasePose(0.0, 0.0, 0.0)
LIMITS = pytest.mark.parametrize("limits", [FORWARD, SIDEWAYS], ids=["forward", "sideways"])
CORRIDOR = [(-1.0, 1.25, 9.0, 1.25), (-1.0, -1.25, 9.0, -1.25), (-1.0, -1.25, -1.0, 1.25)]


def driven(floor: Floor, limits: DriveLimits, radius_m: float = 0.3, to_m: float = 8.0) -> Driven:
    return Drive(floor, limits, radius_m, START, [(to_m, 0.0)]).run()


@LIMITS
@pytest.mark.parametrize(
    "goal", [(3.0, 0.0, 1.5), (-2.0, 1.0, 0.0), (0.1, 0.3, -2.0), (0.0, 0.0, 3.0)]
)
def test_in_free_space_it_arrives_and_does_not_overshoot(
    limits: DriveLimits, goal: tuple[float, float, float]
) -> None:
    drive = Drive(Floor(), limits, 0.3, START, [goal[:2]], goal[2])
    nearest_m = farther_m = 0.0
    end = None
    nearest_m = math.inf
    while end is None:
        end = drive.step()
        away_m = math.dist((drive.at.x, drive.at.y), goal[:2])
        nearest_m = min(nearest_m, away_m)
        if nearest_m < 0.05:
            farther_m = max(farther_m, away_m - nearest_m)
    assert end == "arrived"
    assert farther_m < 0.02


@LIMITS
@pytest.mark.parametrize("speed", [0.3, 0.6, 1.0])
@pytest.mark.parametrize("corner_m", [0.4, 0.8, 1.14])
def test_who_cuts_a_corner_gets_to_the_end_at_any_speed(
    limits: DriveLimits, speed: float, corner_m: float
) -> None:
    way = [(0.0, corner_m), (4.0, corner_m)]
    drive = Drive(Floor(), limits, 0.25, BasePose(0.03, 0.0, 1.35), way, speed=speed)
    assert drive.run().end == "arrived"


@LIMITS
def test_before_a_wall_across_its_way_it_stops(limits: DriveLimits) -> None:
    done = driven(Floor([*CORRIDOR, (4.0, -1.25, 4.0, 1.25)]), limits)
    assert done.end == "barred"
    assert done.nearest_m > 0.0
    assert 0.0 < 4.0 - 0.3 - done.at.x < 0.5


@LIMITS
def test_it_gets_by_a_person_who_stands_in_a_corridor(limits: DriveLimits) -> None:
    done = driven(Floor(CORRIDOR, [(4.0, 0.0, 0.25)]), limits)
    assert done.end == "arrived"
    assert done.nearest_m > 0.1


@LIMITS
def test_it_gets_through_a_door(limits: DriveLimits) -> None:
    done = driven(Floor([(4.0, 0.45, 4.0, 4.0), (4.0, -0.45, 4.0, -4.0)]), limits, radius_m=0.25)
    assert done.end == "arrived"
    assert done.nearest_m > 0.1


@LIMITS
def test_it_drives_into_a_dead_end_and_says_that_it_is_one(limits: DriveLimits) -> None:
    pocket = [(3.0, 1.0, 5.0, 1.0), (5.0, 1.0, 5.0, -1.0), (5.0, -1.0, 3.0, -1.0)]
    barred = [(3.0, 1.0, 3.0, 9.0), (3.0, -1.0, 3.0, -9.0)]
    assert driven(Floor([*pocket, *barred]), limits).end == "barred"


@LIMITS
def test_it_comes_out_of_a_pocket_and_goes_round_it(limits: DriveLimits) -> None:
    pocket = [(3.0, 1.0, 5.0, 1.0), (5.0, 1.0, 5.0, -1.0), (5.0, -1.0, 3.0, -1.0)]
    done = driven(Floor(pocket), limits)
    assert done.end == "arrived"
    assert done.nearest_m > 0.0


@LIMITS
def test_it_cuts_no_corner_through_a_wall(limits: DriveLimits) -> None:
    walls = [(-1.0, 1.0, 3.0, 1.0), (3.0, 1.0, 3.0, 6.0), (-1.0, -1.0, 5.0, -1.0)]
    drive = Drive(Floor(walls), limits, 0.3, START, [(4.0, 0.0), (4.0, 4.0)])
    done = drive.run()
    assert done.end == "arrived"
    assert done.nearest_m > 0.1


@LIMITS
@pytest.mark.parametrize("bearing", [0.0, 0.3, -0.7])
def test_it_comes_to_rest_before_who_steps_in_its_way(limits: DriveLimits, bearing: float) -> None:
    floor = Floor(CORRIDOR)
    drive = Drive(floor, limits, 0.3, START, [(8.0, 0.0)])
    while drive.now.speed_m_s < limits.speed_m_s - 1e-6:
        drive.step()
    stops_m = limits.speed_m_s**2 / (2.0 * limits.acceleration_m_s2)
    away_m = 0.3 + 0.25 + stops_m + limits.speed_m_s * PERIOD_S + 0.05
    x = drive.at.x + away_m * math.cos(bearing)
    floor.things.append((x, drive.at.y + away_m * math.sin(bearing), 0.25))
    done = drive.run()
    assert done.nearest_m > 0.0
    assert done.end == "arrived"


def test_the_same_happens_each_time() -> None:
    ways = []
    for _ in range(2):
        corridor = drawn_corridor(3, 0.3)
        noise = np.random.default_rng(1)
        drive = Drive(corridor.floor, FORWARD, 0.3, corridor.start, corridor.way, 0.0, noise)
        for _ in range(60):
            drive.step()
        ways.append(drive.told)
    assert ways[0] == ways[1]


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample(range(2), range(8)))
def test_in_drawn_corridors_it_touches_nothing_and_arrives_where_there_is_room(seed: int) -> None:
    """Noise of 1 cm; at least 2 radii and 0.2 m wide is room."""
    limits, radius_m = (FORWARD, SIDEWAYS)[seed % 2], (0.25, 0.3, 0.4)[seed % 3]
    corridor = drawn_corridor(seed, radius_m)
    noise = np.random.default_rng(seed)
    done = Drive(corridor.floor, limits, radius_m, corridor.start, corridor.way, 0.5, noise).run()
    assert done.nearest_m > 0.0
    assert done.end != "endless"
    assert done.end == "arrived" or not has_way(corridor, radius_m + 0.1)


def test_a_way_that_leads_on_is_looked_for_once_a_scan(monkeypatch: pytest.MonkeyPatch) -> None:
    searched: list[tuple[float, float]] = []

    def counted(here: tuple[float, float], *rest: Any) -> LocalRoute:
        searched.append(here)
        return find_route(here, *rest)

    monkeypatch.setattr(way_follower, "find_route", counted)
    goal = BasePose(4.0, 0.0, 0.0)
    follower = WayFollower(SIDEWAYS, 0.25, 0.05, [(0.0, 0.0), (4.0, 0.0)], goal)
    free, now, lefts_m = Seen.still(np.array([[0.0, 3.0]])), STANDING, list[float]()
    for cycle in range(6):
        here = BasePose(0.05 * cycle, 0.0, 0.0)
        now = follower.choose(here, now, free, 1.0, scanned_s=0.1 * (cycle // 2))
        assert now.forward_m_s > 0.0
        lefts_m.append(follower.left_m)
    assert len(searched) == 3
    assert lefts_m == sorted(lefts_m, reverse=True)
    assert lefts_m[0] - lefts_m[1] == pytest.approx(0.05)
    turns = np.linspace(0.0, math.tau, 90)
    round_it = Seen.still(0.35 * np.column_stack([np.cos(turns), np.sin(turns)]) + (0.3, 0.0))
    for _ in range(2):
        now = follower.choose(BasePose(0.3, 0.0, 0.0), STANDING, round_it, 1.0, scanned_s=0.4)
        assert follower.barred
