"""Planning of an arm's whole path: which of its many postures reaches every waypoint."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from mend.robots.arm.body import NoWay, ToolPose
from mend.robots.arm.motion.curve import JointCurve
from mend.robots.arm.motion.kinematics import Joints, KinematicChain
from mend.robots.arm.motion.rrt_connect import connect
from mend.robots.body import Matrix4
from mend.robots.vision.seen_box import SeenBox

_LINE_STEPS = 8
"""Postures along a straight line; between them the tool strays less than 0.1 mm."""

_SEEDS = 24
_MOST_SEEDS = 96
"""So many postures are tried where something is in the way of all before."""
_SEED_SPREAD_RAD = 0.6
_ENOUGH_SEEDS = 4
_GOOD_COST = 3.0
_WRIST = slice(4, 6)
_MAX_DIP_M = 0.03
_SAME_SPOT_M = 1e-3
_SAME_YAW_RAD = 5e-3
_SAMPLES_PER_MOVE = 12

_LEAST_DOWNWARD = -0.7
"""On the way around, too, the gripper points down but for 45 degrees."""
_KNOTS_RAD = 0.25


@dataclass(frozen=True, slots=True)
class PathSegment:
    """The way to one waypoint. The parameter of a `straight` one is the tool's way in metres."""

    curve: JointCurve
    straight: bool


@dataclass(frozen=True, slots=True)
class JointPath:
    """A planned path (an `ArmPath`)."""

    ways: tuple[PathSegment, ...]

    @property
    def segments(self) -> int:
        return len(self.ways)


@dataclass(frozen=True, slots=True)
class _Tried:
    """A path with its cost, and what it would touch first."""

    cost: float
    path: JointPath
    hit: SeenBox | None


class Obstacles(Protocol):
    """What a path may not touch."""

    def on(self, number: int, way: PathSegment) -> SeenBox | None:
        """What it would touch on segment `number` of a path; None if nothing."""
        ...

    def is_free(self, number: int, joints: Joints) -> bool:
        """Whether it touches nothing at these joint angles on such a segment."""
        ...


def pose_matrix(pose: ToolPose, yaw_offset: float = 0.0) -> Matrix4:
    """The tool frame: x points down, y along the opening direction of the fingers."""
    yaw = pose.yaw + yaw_offset
    matrix = np.eye(4)
    matrix[:3, 0] = (0.0, 0.0, -1.0)
    matrix[:3, 1] = (math.cos(yaw), math.sin(yaw), 0.0)
    matrix[:3, 2] = np.cross(matrix[:3, 0], matrix[:3, 1])
    matrix[:3, 3] = (pose.x, pose.y, pose.z)
    return matrix


class PathPlanner:
    """Plans paths for one arm through waypoints with the gripper pointing down.

    The fingers are alike, so a whole path may be turned by half a turn: a plan has all its
    waypoints at the yaws asked for, or all of them at yaw + pi. `preferred` is the posture that a
    plan stays close to; staying on one branch of the inverse kinematics is what makes placing
    repeatable.
    """

    def __init__(self, chain: KinematicChain, preferred: Joints) -> None:
        self._chain = chain
        self._preferred = preferred
        # The first solution on a machine compiles for seconds: now, while nobody waits for it.
        chain.solve(chain.pose(preferred), preferred, preferred)

    def plan(
        self,
        start: Joints,
        waypoints: Sequence[ToolPose],
        rng: np.random.Generator,
        obstacles: "Obstacles | None" = None,
    ) -> JointPath | NoWay:
        """Plan from `start` through all waypoints, touching nothing.

        Raises `ValueError` without waypoints.
        """
        if not waypoints:
            raise ValueError("a path needs at least one waypoint")
        best: _Tried | None = None
        hit: SeenBox | None = None
        barred: list[JointPath] = []
        for tried, (seed, yaw_offset) in enumerate(self._attempts(start, rng)):
            if tried >= _SEEDS and (hit is None or best is not None):
                break
            found = self._try(start, waypoints, seed, yaw_offset, obstacles)
            if isinstance(found, SeenBox):
                hit = hit or found
            elif found is not None and found.hit is not None:
                hit = hit or found.hit
                barred.append(found.path)
            elif found is not None and (best is None or found.cost < best.cost):
                best = found
            if best is not None and (tried + 1 >= _ENOUGH_SEEDS or best.cost < _GOOD_COST):
                break
        if best is not None:
            return best.path
        if hit is None or obstacles is None:
            return NoWay("does not reach all of the way with the gripper pointing down")
        for path in barred:
            around = self._detour(path, obstacles, rng)
            if around is not None:
                return around
        return NoWay(f"would touch {hit.name or 'something unknown'} on the way", hit)

    def plan_back(self, start: Joints, waypoints: Sequence[ToolPose]) -> JointPath | None:
        """Back in one go through poses that the tool has just passed, in the same posture."""
        knots, tools, way_m = [start], [self._chain.pose(start)], [0.0]
        for target in map(pose_matrix, waypoints):
            joints = self._chain.solve(target, knots[-1], self._preferred, preference=0.0)
            if joints is None:
                return None
            way_m.append(way_m[-1] + float(np.linalg.norm((target - tools[-1])[:3, 3])))
            knots.append(joints)
            tools.append(target)
        return JointPath((PathSegment(JointCurve(knots, way_m), straight=True),))

    def plan_to_joints(self, start: Joints, end: Joints) -> JointPath:
        """The straight way in joint space."""
        return JointPath((PathSegment(JointCurve([start, end]), straight=False),))

    def _attempts(self, start: Joints, rng: np.random.Generator) -> Iterator[tuple[Joints, float]]:
        """Seeds with the half turn to try them with: the preferred posture first."""
        for number in range(_MOST_SEEDS):
            seed = self._preferred
            if number >= 2:
                seed = seed + rng.normal(0.0, _SEED_SPREAD_RAD, len(start))
            yield seed, math.pi if number % 2 else 0.0

    def _try(
        self,
        start: Joints,
        waypoints: Sequence[ToolPose],
        seed: Joints,
        yaw_offset: float,
        obstacles: "Obstacles | None",
    ) -> "_Tried | SeenBox | None":
        """A path from a seed, or what it would touch where no detour leads around that.

        None where the arm does not reach.
        """
        joints = start
        segments: list[PathSegment] = []
        cost = 0.0
        for index, waypoint in enumerate(waypoints):
            target = pose_matrix(waypoint, yaw_offset)
            origin = self._chain.pose(joints)
            straight = _is_above(origin, target)
            if straight:
                knots = self._straight(origin, target, joints)
            else:
                knots = self._free(target, joints, seed if index == 0 else joints)
            if knots is None:
                return None
            if straight:
                length = abs(float(origin[2, 3] - target[2, 3]))
                curve = JointCurve(
                    [joints, *knots], np.linspace(0.0, length, len(knots) + 1).tolist()
                )
            else:
                cost += self._cost(joints, knots[-1], first=index == 0)
                curve = JointCurve([joints, *knots])
            way = PathSegment(curve, straight)
            if straight and obstacles is not None:
                touched = obstacles.on(index, way)
                if touched is not None:
                    return touched
            segments.append(way)
            joints = knots[-1]
        # Only now, as it takes longest: what free ways touch is nothing where no way leads on.
        return _Tried(cost, JointPath(tuple(segments)), _on_free_ways(segments, obstacles))

    def _straight(self, origin: Matrix4, target: Matrix4, joints: Joints) -> list[Joints] | None:
        knots = []
        for step in range(1, _LINE_STEPS + 1):
            between = target.copy()
            between[2, 3] += (origin[2, 3] - target[2, 3]) * (1 - step / _LINE_STEPS)
            found = self._chain.solve(between, joints, self._preferred, preference=0.0)
            if found is None:
                return None
            knots.append(found)
            joints = found
        return knots

    def _free(self, target: Matrix4, joints: Joints, seed: Joints) -> list[Joints] | None:
        found = self._chain.solve(target, seed, self._preferred)
        if found is None or self._dips(joints, found):
            return None
        return [found]

    def _detour(
        self, path: JointPath, obstacles: Obstacles, rng: np.random.Generator
    ) -> JointPath | None:
        """The path with its free ways led around what is on them; None if that is not found."""
        ways = []
        for number, way in enumerate(path.ways):
            if obstacles.on(number, way) is None:
                ways.append(way)
                continue
            around = None if way.straight else self._around(number, way.curve, obstacles, rng)
            if around is None:
                return None
            ways.append(around)
        return JointPath(tuple(ways))

    def _around(
        self, number: int, curve: JointCurve, obstacles: Obstacles, rng: np.random.Generator
    ) -> PathSegment | None:
        ends = [self._chain.pose(each) for each in (curve.start, curve.end)]
        lowest_m = min(float(each[2, 3]) for each in ends) - _MAX_DIP_M
        most_level = max(_LEAST_DOWNWARD, *(float(each[2, 0]) for each in ends)) + 1e-6

        def is_free(joints: Joints) -> bool:
            tool = self._chain.pose(joints)
            upright = tool[2, 3] >= lowest_m and tool[2, 0] <= most_level
            return bool(upright) and obstacles.is_free(number, joints)

        chain = self._chain
        knots = connect(curve.start, curve.end, chain.lower, chain.upper, is_free, rng)
        if knots is None:
            return None
        way = PathSegment(JointCurve(_denser(knots)), straight=False)
        # The curve rounds the corners off.
        return way if obstacles.on(number, way) is None else None

    def _dips(self, start: Joints, end: Joints) -> bool:
        """Whether the tool comes lower on the way than at both ends, where things lie."""
        heights = [
            float(self._chain.pose(start + (end - start) * part)[2, 3])
            for part in np.linspace(0.0, 1.0, _SAMPLES_PER_MOVE)
        ]
        return min(heights) < min(heights[0], heights[-1]) - _MAX_DIP_M

    def _cost(self, start: Joints, end: Joints, first: bool) -> float:
        """Small for short moves and for postures with the wrist near the preferred one."""
        away = np.abs(end - self._preferred)
        move = 0.3 * away.max() if first else np.abs(end - start).max()
        return float(move + 0.7 * away[_WRIST].max())


def _on_free_ways(ways: Sequence[PathSegment], obstacles: Obstacles | None) -> SeenBox | None:
    """The first thing that a path would touch on what is not straight of it."""
    if obstacles is None:
        return None
    touched = (obstacles.on(each, way) for each, way in enumerate(ways) if not way.straight)
    return next((box for box in touched if box is not None), None)


def _denser(knots: Sequence[Joints]) -> list[Joints]:
    """The same corners with knots between them, so that a curve stays near the straight ways."""
    dense = [knots[0]]
    for start, end in pairwise(knots):
        count = max(1, round(float(np.abs(end - start).max()) / _KNOTS_RAD))
        dense += [start + (end - start) * (step / count) for step in range(1, count + 1)]
    return dense


def _is_above(origin: Matrix4, target: Matrix4) -> bool:
    """Whether a straight vertical line leads from one tool pose to the other."""
    turn = float(np.arccos(np.clip((np.trace(origin[:3, :3].T @ target[:3, :3]) - 1) / 2, -1, 1)))
    apart = float(np.linalg.norm(origin[:2, 3] - target[:2, 3]))
    return apart < _SAME_SPOT_M and turn < _SAME_YAW_RAD
