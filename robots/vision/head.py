"""The head camera: where an object is, from one RGB-D picture."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from robots.body import CameraImage
from robots.catalogue import Part
from robots.grasp import half_turn
from robots.link.messages import Sighting
from robots.vision.blob import Blob, Mask, find_blob
from robots.vision.color_model import Segmentation
from robots.vision.projection import Points, pixels_covered, unproject
from robots.vision.rectangle import TOP_TOLERANCE_M, measure_rectangle

_LAYER_M = 0.004
"""Thickness of the layers in which the top surface is looked for."""
_TOP_SHARE = 0.35
"""The top surface is the highest layer with this share of the fullest layer's points."""
_FEWEST_POINTS = 12
_TOPPLED_M = 0.012
_RIM_PX = 2
_RIM = np.ones((2 * _RIM_PX + 1, 2 * _RIM_PX + 1), np.uint8)
_COMPLETE_SHARE = 0.8
"""A part is seen whole if each extent of its top is at least this share of what it should be."""


@dataclass(frozen=True, slots=True, eq=False)
class HeadSighting:
    """An object in the head picture, in the base frame.

    (x, y, z) is the bottom centre, `yaw` of the part's own x axis (in [-pi/2, pi/2): parts look
    the same after half a turn), `top_z` the height of its top surface. `complete` is False when
    part of the top is hidden or outside the picture: then the centre is that of what is seen.
    `shown` is the share of the top that is seen.
    """

    x: float
    y: float
    z: float
    yaw: float
    top_z: float
    complete: bool
    shown: float
    blob: Blob
    time: float

    def upright(self, table_z: float) -> bool:
        """Whether it can stand as it was built: a toppled part's top is too low for that."""
        return self.z >= table_z - _TOPPLED_M

    def to_message(self, part: Part) -> Sighting:
        """As the robot protocol tells it: with the yaw of the long axis."""
        turn = math.pi / 2 if part.size[1] > part.size[0] else 0.0
        yaw = half_turn(self.yaw + turn)
        return Sighting(x=self.x, y=self.y, z=self.z, yaw=yaw, time=self.time)


def locate(image: CameraImage, segmentation: Segmentation, part: Part) -> HeadSighting | None:
    """Find a part in a head picture; None if it is not seen.

    Raises `ColorModelError` for a part whose colours the model does not know.
    """
    mask = segmentation.mask(part.name)
    blob = find_blob(mask)
    if blob is None or image.depth_m is None:
        return None
    us, vs = _pixels_of(blob, mask, segmentation.of_any())
    points = unproject(image, us, vs)
    top_z = _top_of(points)
    if top_z is None:
        return None
    on_top = np.abs(points[:, 2] - top_z) <= TOP_TOLERANCE_M
    seen = measure_rectangle(image, us[on_top], vs[on_top], top_z, part.size)
    complete = all(
        extent >= _COMPLETE_SHARE * size
        for extent, size in zip(seen.extents, part.size[:2], strict=True)
    )
    return HeadSighting(
        x=seen.center[0],
        y=seen.center[1],
        z=top_z - part.size[2],
        yaw=seen.yaw,
        top_z=top_z,
        complete=complete,
        shown=np.count_nonzero(on_top)
        / pixels_covered(image, (*seen.center, top_z), part.size[:2]),
        blob=blob,
        time=image.time,
    )


def _pixels_of(blob: Blob, mask: Mask, of_any: Mask) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The pixels (us, vs) of a blob and of its rim, but for those of other parts.

    At the rim colours mix, so depth tells where the part ends.
    """
    left, top = max(blob.box[0] - _RIM_PX, 0), max(blob.box[1] - _RIM_PX, 0)
    patch = np.s_[
        top : blob.box[1] + blob.box[3] + _RIM_PX, left : blob.box[0] + blob.box[2] + _RIM_PX
    ]
    grown = np.asarray(cv2.dilate(blob.mask[patch], _RIM))
    vs, us = np.nonzero((grown > 0) & ((mask[patch] > 0) | (of_any[patch] == 0)))
    return us + left, vs + top


def _top_of(points: Points) -> float | None:
    """The height of the top surface.

    A horizontal surface gathers its points in one layer, a side spreads them over many; a knob
    on a plate is too small to be taken for the top.
    """
    if len(points) < _FEWEST_POINTS:
        return None
    heights = points[:, 2]
    layers = np.floor(heights / _LAYER_M).astype(np.intp)
    counts = np.bincount(layers - layers.min())
    # A surface on the border of two layers counts as one.
    paired = counts + np.append(counts[1:], 0)
    highest = int(np.flatnonzero(paired >= _TOP_SHARE * paired.max())[-1])
    middle = (highest + 1 + layers.min()) * _LAYER_M
    near = np.abs(heights - middle) <= _LAYER_M * 1.5
    if np.count_nonzero(near) < _FEWEST_POINTS:
        return None
    return float(np.median(heights[near]))
