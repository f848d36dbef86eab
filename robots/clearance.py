"""Room for the gripper: which of the things that stand around its fingers or palm would touch."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from robots.body import ToolPose
from robots.gripper import GripperModel, ToolBox
from robots.vision.seen_box import SeenBox

_SIGNS = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])


def in_the_way(
    gripper: GripperModel,
    tool: ToolPose,
    opening_m: float,
    boxes: Sequence[SeenBox],
    margin_m: float,
) -> SeenBox | None:
    """The first of `boxes` that a gripper coming straight down to `tool` would come too near to.

    `margin_m` is kept around fingers that are `opening_m` apart, and under them.
    """
    if not boxes:
        return None
    rooms = gripper.boxes(opening_m)
    outlines = np.asarray(shapely.polygons(np.array([_outline(room, tool) for room in rooms])))
    others = np.asarray(shapely.polygons(np.array([box.corners() for box in boxes])))
    near = np.asarray(shapely.distance(outlines[:, None], others[None, :]) < margin_m)
    tops = np.array([box.top_z for box in boxes])
    bottoms = np.array([tool.z + room.bottom_m for room in rooms])
    touched = near & (tops[None, :] > bottoms[:, None] - margin_m)
    found = np.flatnonzero(touched.any(axis=0))
    return boxes[int(found[0])] if len(found) else None


def beside(box: SeenBox, others: Sequence[SeenBox], margin_m: float) -> bool:
    """Whether any other box is nearer than `margin_m`, seen from above."""
    if not others:
        return False
    outlines = np.asarray(shapely.polygons(np.array([each.corners() for each in others])))
    return bool((shapely.distance(shapely.Polygon(box.corners()), outlines) < margin_m).any())


def _outline(room: ToolBox, tool: ToolPose) -> NDArray[np.float64]:
    """The corners (4, 2) of a room around the tool, from above."""
    cos, sin = math.cos(tool.yaw), math.sin(tool.yaw)
    local = _SIGNS * (room.length_m, room.width_m) + (room.along_m, room.aside_m)
    turned: NDArray[np.float64] = local @ np.array([[cos, sin], [-sin, cos]])
    return np.asarray(turned + np.array([tool.x, tool.y]))
