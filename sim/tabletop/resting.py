"""What parts rest on: they fall straight down to the table, another part or the floor."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from sim.tabletop.part import PartPose, TablePart, Whereabouts
from tasks.scene import Table

FLOOR_M = 0.0

_TOUCH_M = 0.006
"""Footprints that overlap less than this slide past each other, as loosely fitting parts do."""

_SINK_M = 0.015
"""A part let go this far inside another is still put on top of it."""


def is_on_table(table: Table, x: float, y: float) -> bool:
    """Whether a point of the plane is over the table."""
    return (
        abs(x - table.center[0]) <= table.size[0] / 2
        and abs(y - table.center[1]) <= table.size[1] / 2
    )


def settle(parts: Iterable[TablePart], table: Table) -> None:
    """Let every resting part fall onto what is below it, the lowest first."""
    resting = sorted(
        (part for part in parts if part.whereabouts is Whereabouts.RESTING),
        key=lambda part: part.pose.z,
    )
    for index, part in enumerate(resting):
        height = support_height(part, part.pose, resting[:index], table)
        if height != part.pose.z:
            part.rest_at(replace(part.pose, z=height))


def on_top(part: TablePart, parts: Iterable[TablePart], table: Table) -> PartPose:
    """Where a part is that is let go: not inside of others, but on top of them."""
    pose = part.pose
    inside = [
        other
        for other in parts
        if other is not part
        and other.whereabouts is Whereabouts.RESTING
        and other.pose.z < pose.z + part.height
    ]
    height = support_height(part, replace(pose, z=math.inf), inside, table)
    return replace(pose, z=max(pose.z, height))


def support_height(
    part: TablePart, pose: PartPose, others: Sequence[TablePart], table: Table
) -> float:
    """The height of the highest surface under a part let go at `pose`."""
    height = table.height if is_on_table(table, pose.x, pose.y) else FLOOR_M
    for other in others:
        top = other.pose.z + other.size[2]
        if height < top <= pose.z + _SINK_M and _overlap(part, pose, other):
            height = top
    return height


def _overlap(part: TablePart, pose: PartPose, other: TablePart) -> bool:
    """Whether two footprints overlap: no edge direction of either separates them."""
    dx, dy = other.pose.x - pose.x, other.pose.y - pose.y
    if math.hypot(dx, dy) > (_diagonal(part) + _diagonal(other)) / 2:
        return False
    for yaw in (pose.yaw, other.pose.yaw):
        for axis in (yaw, yaw + math.pi / 2):
            distance = abs(dx * math.cos(axis) + dy * math.sin(axis))
            room = _half_extent(part, axis - pose.yaw) + _half_extent(other, axis - other.pose.yaw)
            if distance > room - _TOUCH_M:
                return False
    return True


def _diagonal(part: TablePart) -> float:
    return math.hypot(part.size[0], part.size[1])


def _half_extent(part: TablePart, direction: float) -> float:
    return (abs(part.size[0] * math.cos(direction)) + abs(part.size[1] * math.sin(direction))) / 2
