"""The space over the table that an arm has where several work: at rest, and for a leaf."""

from collections.abc import Sequence
from math import hypot
from typing import Protocol

from shapely import MultiPoint
from shapely.geometry.base import BaseGeometry

from mend.tasks.frames import Frame
from mend.tasks.scene import SceneObject

Flat = tuple[float, float]
"""A point of the scene's plane."""


class Room(Protocol):
    """An `ArmRoom`, or what a robot says of its own on the link."""

    @property
    def resting(self) -> Sequence[Flat]: ...

    @property
    def hand_over(self) -> Flat: ...

    @property
    def around_m(self) -> float: ...


def home_points(frame: Frame, room: Room) -> list[Flat]:
    """The corners of what an arm covers at rest."""
    return [frame.to_scene(*each) for each in room.resting]


def home(frame: Frame, room: Room) -> BaseGeometry:
    """Where an arm is that rests."""
    return MultiPoint(home_points(frame, room)).convex_hull.buffer(room.around_m)


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
    corners = [*home_points(frame, room), *ends]
    if handed_over:
        corners.append(frame.to_scene(*room.hand_over))
    return MultiPoint(corners).convex_hull.buffer(around_m)
