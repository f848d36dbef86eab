"""Somebody in the arm's way: a box on the table, and where the gripper runs into it."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mend.robots.arm.body import ToolPose

SIZE_M = (0.10, 0.10, 0.40)

_GRIPPER_RADIUS_M = 0.05
"""What of the gripper is around the tool point; its tips reach hardly below that."""
_ROOM_M = 0.06
"""So much room is left between the gripper and somebody who gets in its way."""
_UNDER_M = 0.03
"""Who gets under a gripper that comes down is so far below it."""
_STEP_M = 0.005


@dataclass(frozen=True, slots=True)
class Blocker:
    """Upright around (x, y), its top at `top_z`."""

    x: float
    y: float
    top_z: float

    @property
    def foot(self) -> tuple[float, float, float]:
        """The middle of its bottom."""
        return self.x, self.y, self.top_z - SIZE_M[2]

    def meets(self, tool: ToolPose) -> bool:
        """Whether it and the gripper are in one place."""
        aside_m = max(abs(tool.x - self.x) - SIZE_M[0] / 2, abs(tool.y - self.y) - SIZE_M[1] / 2)
        return aside_m < _GRIPPER_RADIUS_M and tool.z < self.top_z


def on_the_way(way: Sequence[ToolPose], table_z: float) -> Blocker | None:
    """Where somebody stands so that the tool, at the first pose of its way, will run into them.

    None where the way ends before that or leads over their head.
    """
    top_z = table_z + SIZE_M[2]
    if len(way) > 1 and _sinks(way[0], way[1]):
        # Under the side of a gripper that comes down: what is below its middle stays free.
        return Blocker(way[0].x, way[0].y + SIZE_M[1] / 2, way[0].z - _UNDER_M)
    apart_m = _GRIPPER_RADIUS_M + math.hypot(*SIZE_M[:2]) / 2 + _ROOM_M
    for start, end in pairwise(way):
        for share in shares_between(start, end):
            tool = between(start, end, share)
            far = math.hypot(tool.x - way[0].x, tool.y - way[0].y) >= apart_m
            if far and tool.z < top_z:
                return Blocker(tool.x, tool.y, top_z)
    return None


def _sinks(start: ToolPose, end: ToolPose) -> bool:
    """Whether the way leads straight down, far enough for somebody to be met on it."""
    straight = math.hypot(end.x - start.x, end.y - start.y) < _STEP_M
    return straight and end.z < start.z - 2 * _UNDER_M


def shares_between(start: ToolPose, end: ToolPose) -> Iterator[float]:
    """Shares of the straight line between tool poses, up to 1, close to one another."""
    length_m = math.dist((start.x, start.y, start.z), (end.x, end.y, end.z))
    count = max(1, math.ceil(length_m / _STEP_M))
    yield from (number / count for number in range(1, count + 1))


def between(start: ToolPose, end: ToolPose, share: float) -> ToolPose:
    """The tool pose at a share of the straight line; it turns the shorter way."""
    turn = (end.yaw - start.yaw + math.pi) % (2 * math.pi) - math.pi
    return ToolPose(
        start.x + (end.x - start.x) * share,
        start.y + (end.y - start.y) * share,
        start.z + (end.z - start.z) * share,
        start.yaw + turn * share,
    )
