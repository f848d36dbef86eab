"""What stands in the way: unknown things in the head's depth picture where the arm is to go."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.body import ToolPose
from mend.robots.body import CameraImage
from mend.robots.vision.carriers import below
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.projection import Points, pixels_covered, project
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.table_view import TableView

_BOTTOM_ERROR_M = 0.010
"""So well is it known how high a part stands."""

_CARRIER_M = 0.012
"""What carries a part, and is told by its sides alone, reaches so far beyond it."""

Segment = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Two ends in the base frame."""


@dataclass(frozen=True, slots=True)
class Clearance:
    """How much room the arm needs. Lengths in metres.

    `radius_m` around the way of the tool point; what is lower than `above_table_m` over the table
    is the table; fewer than `fewest_px` pixels are noise.
    """

    radius_m: float = 0.07
    above_table_m: float = 0.02
    fewest_px: int = 100


@dataclass(frozen=True, slots=True)
class Obstruction:
    """Something in the way: its middle in the base frame and in the picture.

    `part` is its name if it is a known part; `what` says what it is and of what it is in the way.
    """

    position: tuple[float, float, float]
    center: tuple[float, float]
    area_px: int
    part: str | None = None
    what: str = "something unknown is in the arm's way"


def corridor(waypoints: Sequence[ToolPose]) -> list[Segment]:
    """The tool point's way through waypoints, as straight segments."""
    points = [np.array([each.x, each.y, each.z]) for each in waypoints]
    return list(pairwise(points))


def find_obstruction(
    view: TableView, way: Sequence[Segment], clearance: Clearance, taking: str | None = None
) -> Obstruction | None:
    """What is in `way` that is neither table nor known part, nor carries one.

    Of a stack only the uppermost parts can be told by name: what is seen below them, and hardly
    farther out, belongs to it. What carries the part to be taken may be wide, as the arm goes no
    lower than that part.
    """
    if not way:
        return None
    us, vs, points = view.standing_out(view.heights.table_z + clearance.above_table_m)
    inside = near(points, way, clearance.radius_m)
    taken = None if taking is None else view.sightings.get(taking)
    if taken is not None:
        inside &= ~_carries(points, taken, clearance)
    us, vs, points = us[inside], vs[inside], points[inside]
    for box in view.known:
        carrier = below(box, view.heights.table_z)
        unknown = ~(box.holds(points) | carrier.holds(points, _CARRIER_M))
        us, vs, points = us[unknown], vs[unknown], points[unknown]
    canvas = np.zeros(view.heights.height_m.shape, np.uint8)
    canvas[vs, us] = 255
    clean = np.asarray(cv2.morphologyEx(canvas, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)))
    return obstruction_of(us, vs, points, clean[vs, us] > 0, clearance.fewest_px)


def _carries(points: Points, taken: HeadSighting, clearance: Clearance) -> NDArray[np.bool_]:
    """Which points are below the bottom of a part, and as near as the way down to it is wide."""
    aside_m = np.hypot(points[:, 0] - taken.x, points[:, 1] - taken.y)
    lower: NDArray[np.bool_] = points[:, 2] <= taken.z + _BOTTOM_ERROR_M
    return lower & (aside_m <= clearance.radius_m)


def obstruction_of(
    us: NDArray[np.intp],
    vs: NDArray[np.intp],
    points: Points,
    kept: NDArray[np.bool_],
    fewest_px: float,
) -> Obstruction | None:
    """The thing that the `kept` of some pixels show; None if they are too few."""
    area_px = int(np.count_nonzero(kept))
    if area_px < max(fewest_px, 1):
        return None
    middle = np.median(points[kept], axis=0)
    return Obstruction(
        position=(float(middle[0]), float(middle[1]), float(middle[2])),
        center=(float(np.median(us[kept])), float(np.median(vs[kept]))),
        area_px=area_px,
    )


def obstruction_at(box: SeenBox, image: CameraImage) -> Obstruction:
    """A seen box as something in the way."""
    top = (box.x, box.y, box.top_z)
    u, v = project(image, np.array([top]))[0]
    return Obstruction(
        position=top,
        center=(float(u), float(v)),
        area_px=round(pixels_covered(image, top, box.size[:2])),
        part=box.name,
    )


def near(points: Points, segments: Sequence[Segment], radius_m: float) -> NDArray[np.bool_]:
    """Which points are within `radius_m` of any of the segments."""
    found = np.zeros(len(points), np.bool_)
    for start, end in segments:
        along = end - start
        length_2 = float(along @ along)
        share = (points - start) @ along / length_2 if length_2 > 0 else np.zeros(len(points))
        closest = start + np.clip(share, 0.0, 1.0)[:, None] * along
        found |= ((points - closest) ** 2).sum(axis=1) <= radius_m * radius_m
    return found
