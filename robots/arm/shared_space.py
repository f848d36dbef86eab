"""The space over the table that an arm has where several work: at rest, and for a leaf."""

from collections.abc import Sequence
from itertools import combinations
from math import atan2, ceil, cos, hypot, pi, remainder, sin
from typing import Protocol

from shapely import MultiPoint
from shapely.geometry.base import BaseGeometry

from mend.tasks.frames import Frame
from mend.tasks.scene import SceneObject

Flat = tuple[float, float]
"""A point of the scene's plane."""


_ARC_STEP_RAD = 0.15


class Swings(Protocol):
    """A `Swing`, or what a robot says of its own on the link."""

    @property
    def pivot(self) -> Flat: ...

    @property
    def tool(self) -> Flat: ...


class Room(Protocol):
    """An `ArmRoom`, or what a robot says of its own on the link."""

    @property
    def resting(self) -> Sequence[Flat]: ...

    @property
    def hand_over(self) -> Flat: ...

    @property
    def around_m(self) -> float: ...

    @property
    def swing(self) -> Swings | None: ...

    @property
    def torso(self) -> Sequence[Flat]: ...


def home_points(frame: Frame, room: Room) -> list[Flat]:
    """The corners of what an arm covers at rest."""
    return [frame.to_scene(*each) for each in room.resting]


def home(frame: Frame, room: Room) -> BaseGeometry:
    """Where an arm is that rests."""
    return _space(frame, room, home_points(frame, room), room.around_m)


def leaf_space(
    frame: Frame,
    room: Room,
    ends: Sequence[Flat],
    part: SceneObject | None,
    *,
    handed_over: bool = False,
) -> BaseGeometry:
    """Where an arm may be that takes a part from one of `ends` to another.

    `handed_over`: also where people hold it out.
    """
    around_m = room.around_m + (0.0 if part is None else hypot(*part.size[:2]) / 2)
    tools = [*ends, frame.to_scene(*room.hand_over)] if handed_over else list(ends)
    corners = [*home_points(frame, room), *tools]
    if room.swing is not None:
        pivot = frame.to_scene(*room.swing.pivot)
        tools.append(frame.to_scene(*room.swing.tool))
        for one, two in combinations(tools, 2):
            corners += _arc(pivot, one, two)
    return _space(frame, room, corners, around_m)


def _space(frame: Frame, room: Room, corners: Sequence[Flat], around_m: float) -> BaseGeometry:
    """What an arm takes around such corners, and what of its robot is always there."""
    space = MultiPoint(corners).convex_hull.buffer(around_m)
    if not room.torso:
        return space
    return space.union(MultiPoint([frame.to_scene(*each) for each in room.torso]).convex_hull)


def _arc(pivot: Flat, one: Flat, two: Flat) -> list[Flat]:
    """Points from the direction of one to that of the other, as far away as the farther one."""
    directions = [atan2(each[1] - pivot[1], each[0] - pivot[0]) for each in (one, two)]
    away_m = max(hypot(each[0] - pivot[0], each[1] - pivot[1]) for each in (one, two))
    turn = remainder(directions[1] - directions[0], 2 * pi)
    steps = max(1, ceil(abs(turn) / _ARC_STEP_RAD))
    angles = [directions[0] + turn * step / steps for step in range(steps + 1)]
    return [(pivot[0] + away_m * cos(each), pivot[1] + away_m * sin(each)) for each in angles]
