"""Where a robot is that is on its way, and where it can leave that way."""

from itertools import pairwise

from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.robot_state import TrackedRobot

Passing = tuple[int, float]
"""A place, and when the robot is there."""


def stand_still(robot: TrackedRobot, ways: OpenWays | None, now_s: float) -> None:
    """The robot stops at the last place of its way that it has passed.

    Where the ways are not known, at the end of its trip that is nearer.
    """
    if robot.trip is not None and robot.free_s > now_s:
        passed = [place for place, there_s in _path(robot, ways) if there_s <= now_s]
        if passed:
            robot.place = passed[-1]
        elif robot.free_s - now_s > now_s - robot.trip.leaves_s:
            robot.place = robot.trip.origin
    robot.free_s, robot.trip = now_s, None


def turn_before(
    robot: TrackedRobot, ways: OpenWays, stopped: frozenset[int], now_s: float
) -> Passing | None:
    """Where a robot leaves its way for what is closed on it: at the next place, or, where it is in
    there already, at the one before; None where it does not come through there any more."""
    if robot.trip is None or robot.free_s <= now_s:
        return None
    path = _path(robot, ways)
    if path and path[0][1] >= now_s:
        path = ((path[0][0], now_s), *path[1:])
    for (place, there_s), (following, then_s) in pairwise(path):
        if {place, following} <= stopped and then_s > now_s:
            if there_s <= now_s:
                return place, 2 * now_s - there_s
            return next(each for each in path if each[1] >= now_s)
    return None


def _path(robot: TrackedRobot, ways: OpenWays | None) -> tuple[Passing, ...]:
    assert robot.trip is not None, "it is on its way"
    if ways is None:
        return ()
    trip = (robot.trip.origin, robot.place)
    return ways.path(trip, robot.free_s, robot.trip.leaves_s, robot.robot.speed)
