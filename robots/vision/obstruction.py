"""What stands in the way: things in the head's depth picture where the arm is about to go."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from robots.body import CameraImage, ToolPose
from robots.vision.color_model import Segmentation
from robots.vision.projection import Points, heights, unproject

Segment = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Two ends in the base frame."""


@dataclass(frozen=True, slots=True)
class Clearance:
    """How much room the arm needs. Lengths in metres.

    `radius_m` around the way of the tool point; what is lower than `above_table_m` over the table
    is the table; `arm_radius_m` around the arm itself is the arm; fewer than `fewest_px` pixels
    are noise.
    """

    radius_m: float = 0.07
    above_table_m: float = 0.02
    arm_radius_m: float = 0.16
    fewest_px: int = 40


@dataclass(frozen=True, slots=True)
class Obstruction:
    """Something in the way: its middle in the base frame and in the picture.

    `what` says what it is and of what it is in the way.
    """

    position: tuple[float, float, float]
    center: tuple[float, float]
    area_px: int
    what: str = "something unknown is in the arm's way"


def corridor(waypoints: Sequence[ToolPose]) -> list[Segment]:
    """The tool point's way through waypoints, as straight segments."""
    points = [np.array([each.x, each.y, each.z]) for each in waypoints]
    return list(pairwise(points))


def find_obstruction(
    image: CameraImage,
    segmentation: Segmentation,
    way: Sequence[Segment],
    arm: Sequence[Segment],
    table_z: float,
    clearance: Clearance,
) -> Obstruction | None:
    """The first thing in `way` that is neither table nor known part nor the `arm` itself."""
    if image.depth_m is None or not way:
        return None
    # A rim of a part mixes its colour with what is behind; widening the parts covers the rims.
    known = cv2.dilate(segmentation.of_any(), np.ones((5, 5), np.uint8))
    # Most of a picture is table and floor: only what stands out is compared with the way.
    high = heights(image) > table_z + clearance.above_table_m
    vs, us = np.nonzero(high & (np.asarray(known) == 0))
    points = unproject(image, us, vs)
    inside = near(points, way, clearance.radius_m)
    if arm:
        inside &= ~near(points, arm, clearance.arm_radius_m)
    canvas = np.zeros(image.bgr.shape[:2], np.uint8)
    canvas[vs[inside], us[inside]] = 255
    clean = cv2.morphologyEx(canvas, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    kept = np.asarray(clean)[vs, us] > 0
    area_px = int(np.count_nonzero(kept))
    if area_px < clearance.fewest_px:
        return None
    middle = np.median(points[kept], axis=0)
    return Obstruction(
        position=(float(middle[0]), float(middle[1]), float(middle[2])),
        center=(float(np.median(us[kept])), float(np.median(vs[kept]))),
        area_px=area_px,
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
