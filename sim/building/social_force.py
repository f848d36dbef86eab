"""The social force model of Helbing and Molnar (1995): how people step round things."""

import math

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.clearance import distances_m
from mend.sim.building.building_robot import PERIOD_S, BuildingRobot
from mend.sim.building.bystander import RADIUS_M

Matrix = NDArray[np.float64]

# Relaxation, strength and reach of repulsion.
_RELAX_S = 0.5
_PUSH_M_S2 = 2.0
_PUSH_REACH_M = 0.3
KEEP_M = 0.05
"""People keep so far from each other, and from walls."""
_KEEP_FROM_ROBOTS_M = 0.25
_ROBOT_AHEAD_S = 1.0
"""Nobody steps to where a robot is going to be so soon."""
_TURNS_RAD = (0.0, -0.4, 0.4, -0.8, 0.8, -1.2, 1.2, -1.6, 1.6)


def ahead(
    robot: BuildingRobot, keep_m: float = _KEEP_FROM_ROBOTS_M
) -> list[tuple[float, float, float]]:
    """A robot as people avoid it, by so much: where it is, and where it is about to be."""
    at, now = robot.at, robot.velocity()
    cos, sin = math.cos(at.yaw), math.sin(at.yaw)
    vx = now.forward_m_s * cos - now.left_m_s * sin
    vy = now.forward_m_s * sin + now.left_m_s * cos
    radius_m = robot.radius_m + keep_m
    times = (0.0, 0.33, 0.67, 1.0) if vx or vy else (0.0,)
    soon = [_ROBOT_AHEAD_S * each for each in times]
    return [(at.x + vx * each, at.y + vy * each, radius_m) for each in soon]


def pushed(
    velocity: Matrix,
    here: Matrix,
    goal: Matrix,
    speed_m_s: float,
    around: Matrix,
    most_m_s: float | None = None,
) -> Matrix:
    """The velocity after one cycle: drawn to the goal, pushed off what is round.

    Who is at the goal wants to stand. `most_m_s`: as fast as who is pushed, where that is more.
    """
    to_goal = goal - here
    force = (speed_m_s * to_goal / max(np.hypot(*to_goal), 1e-6) - velocity) / _RELAX_S
    if len(around):
        off = here - around[:, :2]
        away_m = np.maximum(np.hypot(off[:, 0], off[:, 1]), 1e-6)
        push = _PUSH_M_S2 * np.exp((around[:, 2] + RADIUS_M - away_m) / _PUSH_REACH_M)
        force = force + (np.minimum(push, 4.0)[:, None] * off / away_m[:, None]).sum(axis=0)
    changed = velocity + force * PERIOD_S
    fast = float(np.hypot(*changed))
    return np.asarray(changed * min(1.0, (most_m_s or speed_m_s) / max(fast, 1e-9)))


def free_step(here: Matrix, velocity: Matrix, around: Matrix, walls: Matrix) -> Matrix | None:
    """Where one cycle leads without touching anything, a little aside if need be; None: nowhere.

    Who is too near to something already may only get farther from it.
    """
    turns = np.array(_TURNS_RAD)
    cos, sin = np.cos(turns), np.sin(turns)
    steps = PERIOD_S * np.stack(
        [velocity[0] * cos - velocity[1] * sin, velocity[0] * sin + velocity[1] * cos], axis=1
    )
    to = here + steps
    free = np.ones(len(to), dtype=bool)
    if len(around):
        need = around[:, 2] + RADIUS_M
        now = np.hypot(*(here - around[:, :2]).T)
        then = np.hypot(*np.moveaxis(to[:, None] - around[None, :, :2], 2, 0))
        free &= (then >= np.minimum(need, now)).all(axis=1)
    near_m, now_m = distances_m(to, walls), float(distances_m(here[None], walls)[0])
    free &= near_m >= min(RADIUS_M + KEEP_M, now_m)
    found = np.flatnonzero(free)
    return np.asarray(to[found[0]]) if len(found) else None
