"""Room for the gripper: which of the things that stand around its fingers or palm would touch."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from mend.robots.arm.body import ToolPose
from mend.robots.arm.gripper import GripperModel, ToolBox
from mend.robots.vision.seen_box import SeenBox

_SIGNS = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])


ROOM_M = 0.002
"""Enough between the gripper and what stands beside it: scenes are checked for so much. It is more
than what is seen may be off by."""

_ROUNDING_M = 1e-9

_NEAR_M = 0.05
"""What is farther away leaves room enough, however much that is."""


@dataclass(frozen=True, slots=True)
class Gap:
    """How much room there is between a gripper and what is nearest to it, beside or under it."""

    room_m: float
    to: SeenBox


def room_around(
    gripper: GripperModel,
    tool: ToolPose,
    opening_m: float,
    boxes: Sequence[SeenBox],
    *,
    closed_m: float | None = None,
    stray_m: float = 0.0,
) -> Gap | None:
    """The room that `boxes` leave a gripper coming straight down to `tool`; None if none is near.

    Its fingers are `opening_m` apart, and close to `closed_m` there, or open from it. Boxes may be
    `stray_m` nearer, in the plane, than they are said to be. Where they meet the gripper the room
    is 0 or less.
    """
    rooms = gripper.swept_boxes(opening_m if closed_m is None else closed_m, opening_m)
    corners = _outlines(rooms, tool)
    spread_m = float(np.linalg.norm(corners - (tool.x, tool.y), axis=-1).max())
    boxes = [each for each in boxes if _apart_m(each, tool) < spread_m + stray_m + _NEAR_M]
    if not boxes:
        return None
    bottoms = np.array([tool.z + room.bottom_m for room in rooms])
    above = bottoms[:, None] - np.array([box.top_z for box in boxes])[None, :]
    outlines = np.asarray(shapely.polygons(corners))

    def left_m(some: NDArray[np.intp]) -> NDArray[np.float64]:
        others = np.asarray(shapely.polygons(np.array([boxes[each].corners() for each in some])))
        apart = np.asarray(shapely.distance(outlines[:, None], others[None, :])) - stray_m
        return np.asarray(np.maximum(apart, above[:, some]).min(axis=0))

    # Circles tell of most boxes that another one is nearer.
    least_m = np.maximum(_circles_apart_m(corners, boxes) - stray_m, above).min(axis=0)
    enough_m = left_m(least_m.argmin(keepdims=True))[0]
    some = np.flatnonzero(least_m <= enough_m)
    left = left_m(some)
    nearest = int(left.argmin())
    return Gap(float(left[nearest]), boxes[some[nearest]])


def rooms_around(
    gripper: GripperModel,
    tool: ToolPose,
    opening_m: float,
    boxes: Sequence[SeenBox],
    outlines: NDArray[np.object_],
    *,
    closed_m: float,
    most_m: float,
) -> NDArray[np.float64]:
    """The room that each of `boxes`, by itself, leaves a gripper (`room_around`), up to `most_m`.

    `outlines` are the polygons of the boxes.
    """
    rooms = gripper.swept_boxes(closed_m, opening_m)
    corners = _outlines(rooms, tool)
    bottoms = np.array([tool.z + room.bottom_m for room in rooms])
    above = bottoms[:, None] - np.array([box.top_z for box in boxes])[None, :]
    left_m = np.maximum(_circles_apart_m(corners, boxes), above)
    near, some = np.nonzero(left_m < most_m)
    fingers = np.asarray(shapely.polygons(corners))
    left_m[near, some] = np.maximum(
        shapely.distance(fingers[near], outlines[some]), above[near, some]
    )
    return np.asarray(left_m.min(axis=0).clip(max=most_m))


def in_the_way(
    gripper: GripperModel,
    tool: ToolPose,
    opening_m: float,
    boxes: Sequence[SeenBox],
    margin_m: float,
    *,
    closed_m: float | None = None,
    stray_m: float = 0.0,
) -> SeenBox | None:
    """Which of `boxes` leaves least room, where that is less than `margin_m` (`room_around`)."""
    room = room_around(gripper, tool, opening_m, boxes, closed_m=closed_m, stray_m=stray_m)
    return room.to if room is not None and room.room_m < margin_m else None


def beside(box: SeenBox, others: Sequence[SeenBox], margin_m: float) -> bool:
    """Whether any other box is nearer than `margin_m`, seen from above."""
    if not others:
        return False
    outlines = np.asarray(shapely.polygons(np.array([each.corners() for each in others])))
    return bool((shapely.distance(shapely.Polygon(box.corners()), outlines) < margin_m).any())


def _outlines(rooms: Sequence[ToolBox], tool: ToolPose) -> NDArray[np.float64]:
    """The corners (n, 4, 2) of rooms around the tool, from above."""
    cos, sin = math.cos(tool.yaw), math.sin(tool.yaw)
    extents = np.array([(room.length_m, room.width_m) for room in rooms])
    middles = np.array([(room.along_m, room.aside_m) for room in rooms])
    local = _SIGNS * extents[:, None] + middles[:, None]
    turned: NDArray[np.float64] = local @ np.array([[cos, sin], [-sin, cos]])
    return np.asarray(turned + np.array([tool.x, tool.y]))


def _circles_apart_m(corners: NDArray[np.float64], boxes: Sequence[SeenBox]) -> NDArray[np.float64]:
    """At least so far is each outline (n, 4, 2) from each box (m), from above: (n, m)."""
    middles = corners.mean(axis=1)
    radii_m = np.linalg.norm(corners - middles[:, None], axis=-1).max(axis=1)
    boxes_m = np.array([math.hypot(*box.size[:2]) / 2 for box in boxes])
    away_m = cdist(middles, np.array([(box.x, box.y) for box in boxes]))
    return np.asarray(away_m - radii_m[:, None] - boxes_m - _ROUNDING_M)


def _apart_m(box: SeenBox, tool: ToolPose) -> float:
    """At least so far is a box from the tool, from above."""
    return math.hypot(box.x - tool.x, box.y - tool.y) - math.hypot(*box.size[:2]) / 2
