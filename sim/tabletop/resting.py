"""What parts rest on: they fall straight down to the table, another part or the floor."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from mend.sim.tabletop.part import TablePart, UprightPose, Whereabouts
from mend.tasks.scene import Table

FLOOR_M = 0.0

_SINK_M = 0.015
"""A part let go this far inside another is still put on top of it."""


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


def on_top(part: TablePart, parts: Iterable[TablePart], table: Table) -> UprightPose:
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
    part: TablePart, pose: UprightPose, others: Sequence[TablePart], table: Table
) -> float:
    """The height of the highest surface under a part let go at `pose`."""
    covered = part.footprint_at(pose)
    height = table.height if table.is_under(pose.x, pose.y) else FLOOR_M
    for other in others:
        top = other.pose.z + other.size[2]
        if height < top <= pose.z + _SINK_M and covered.overlaps(other.footprint):
            height = top
    return height
