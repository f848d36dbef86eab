"""Where a held part must be seen in the forearm picture: its outline but for what hides it."""

from collections.abc import Sequence
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.grasp import Grasp, corners_in_tool
from mend.robots.arm.grip.composition import Composition
from mend.robots.body import CameraImage, Matrix4
from mend.robots.catalogue import Part
from mend.robots.vision.blob import Mask
from mend.robots.vision.color_model import ColorModel, Segmentation
from mend.robots.vision.projection import NEAR_M, project
from mend.robots.vision.seen_box import SeenBox

REFERENCE_WIDTH_PX = 160
"""Lengths in pixels are for a picture this wide and grow with it."""

_NEAR_M = 0.04
"""So near to the tool point a part stays where it is even if it turns between the fingers."""

_RIM_PX = 2.0
"""Projections are that exact: the tool point's and the grasp's error, seen from the forearm."""

_BOX_EDGES = [
    *((2 * side, 2 * side + 1) for side in range(4)),
    *((2 * side + end, 2 * ((side + 1) % 4) + end) for side in range(4) for end in range(2)),
]
"""Of corners that go around, each at the bottom and then at the top."""

_TELLING_SHARE = 0.5
"""Of a part without a hue nothing is seen but that much of another's colour is not its own."""

_FEWEST_PX = 14
"""Fewer pixels than these may be anything."""


def outline(
    image: CameraImage,
    tool: Matrix4,
    pieces: Sequence[NDArray[np.float64]],
    shift_px: NDArray[np.float64] | None = None,
) -> Mask:
    """Where convex pieces, points (n, 3) in the tool frame, would be seen: 1 there, 0 elsewhere."""
    canvas = np.zeros(image.bgr.shape[:2], np.uint8)
    for points in pieces:
        pixels = project(image, points @ tool[:3, :3].T + tool[:3, 3])
        if shift_px is not None:
            pixels = pixels + shift_px
        hull = cv2.convexHull(np.rint(pixels).astype(np.int32))
        cv2.fillConvexPoly(canvas, hull, 1)
    return canvas


def near_tool(part: Part, grasp: Grasp) -> list[NDArray[np.float64]]:
    """The corners of the part's boxes, cut off where they are far from the tool point."""
    pieces = [np.clip(each, -_NEAR_M, _NEAR_M) for each in corners_in_tool(part, grasp)]
    return [each for each in pieces if np.ptp(each, axis=0).min() > 0.0]


def visible_region(
    image: CameraImage,
    tool: Matrix4,
    near: Sequence[NDArray[np.float64]],
    fingers: Sequence[NDArray[np.float64]],
) -> Mask:
    """Where the part must be seen and neither its rim nor a finger, or the like, is."""
    rim = rim_of(image)
    inside = cv2.erode(outline(image, tool, near), rim)
    hidden = cv2.dilate(outline(image, tool, fingers), rim)
    return np.where((np.asarray(inside) > 0) & (np.asarray(hidden) == 0), 1, 0).astype(np.uint8)


def rim_of(image: CameraImage) -> Mask:
    """As far around each pixel as projections may be off."""
    size = 2 * round(_RIM_PX * image.bgr.shape[1] / REFERENCE_WIDTH_PX) + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)), np.uint8)


def in_front(
    image: CameraImage, tool: Matrix4, boxes: Sequence[SeenBox]
) -> list[NDArray[np.float64]]:
    """The corners (n, 3), in the tool frame, of boxes between the camera and what the tool holds.

    `boxes` are in the base frame; one that reaches beside the camera is cut off there.
    """
    eye = image.pose[:3, 3]
    away_m = float(np.linalg.norm(tool[:3, 3] - eye))
    nearer = [each for each in boxes if np.linalg.norm(_corners(each).mean(axis=0) - eye) < away_m]
    return in_tool(image, tool, nearer)


def in_tool(
    image: CameraImage, tool: Matrix4, boxes: Sequence[SeenBox]
) -> list[NDArray[np.float64]]:
    """The corners (n, 3), in the tool frame, of boxes in the base frame, cut off as `in_front`."""
    eye = image.pose[:3, 3]
    found = []
    for corners in map(_corners, boxes):
        ahead = _ahead(corners, (corners - eye) @ image.pose[:3, 2] - NEAR_M)
        if len(ahead) > 0:
            found.append((ahead - tool[:3, 3]) @ tool[:3, :3])
    return found


@lru_cache(maxsize=256)
def _corners(box: SeenBox) -> NDArray[np.float64]:
    return np.array([(x, y, z) for x, y in box.corners() for z in (box.bottom_z, box.top_z)])


def _ahead(corners: NDArray[np.float64], beyond_m: NDArray[np.float64]) -> NDArray[np.float64]:
    """The corners of what is left of a box beyond a plane; `beyond_m` (8,) is below 0 before it."""
    left = [corners[beyond_m > 0.0]]
    for one, other in _BOX_EDGES:
        if beyond_m[one] * beyond_m[other] < 0.0:
            share = beyond_m[one] / (beyond_m[one] - beyond_m[other])
            left.append((corners[one] + share * (corners[other] - corners[one]))[None])
    return np.concatenate(left)


def composition(
    region: Mask, segmentation: Segmentation, model: ColorModel, name: str
) -> Composition | None:
    """Which colours a region shows; None where that cannot tell whether it is part `name`.

    What may be the part's own colour is no sign of another part, even of one that has more of it.
    """
    if name not in model.names:
        return None
    scale = region.shape[1] / REFERENCE_WIDTH_PX
    if model.has_hue(name):
        region = np.where(segmentation.tells(name), region, 0).astype(np.uint8)
    pixels = int(np.count_nonzero(region))
    if pixels < _FEWEST_PX * scale * scale:
        return None
    inside = segmentation.within(region)
    own = inside.may_be(name)
    others = {
        other: float(np.mean((inside.mask(other) > 0) & ~own))
        for other in model.names
        if other != name
    }
    most = max(others, key=lambda other: others[other], default=None)
    share = 0.0 if most is None else others[most]
    if not model.has_hue(name) and share < _TELLING_SHARE:
        return None
    return Composition(pixels, float(np.mean(own)), share, most if share > 0.0 else None)
