"""Whether a place is free: what the head's depth picture shows in the room for a part."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from robots.body import CameraImage
from robots.catalogue import Part
from robots.link.messages import Location
from robots.vision.color_model import Segmentation
from robots.vision.obstruction import Clearance, Obstruction, Segment, near
from robots.vision.projection import Points, heights, unproject

_RIM = np.ones((5, 5), np.uint8)
"""Colours mix at a part's rim; so much wider it hides none of what is beside it."""


@dataclass(frozen=True, slots=True)
class Room:
    """The room that `part` takes at a place: upright, with its bottom at `bottom_z`."""

    part: Part
    at: Location
    bottom_z: float


@dataclass(frozen=True, slots=True)
class Fit:
    """How exactly a room has to be free. Lengths in metres.

    What reaches less than `margin_m` into it from the side or `tolerance_m` from below is its
    neighbour or what carries it. Something is in it that covers `share` of its floor and at least
    `fewest_px` pixels. Up to `approach_m` over it nothing may be either.
    """

    margin_m: float = 0.008
    tolerance_m: float = 0.010
    approach_m: float = 0.06
    share: float = 0.08
    fewest_px: int = 6


def find_occupant(
    image: CameraImage,
    segmentation: Segmentation,
    room: Room,
    arm: Sequence[Segment],
    clearance: Clearance,
    fit: Fit,
) -> Obstruction | None:
    """What is in `room` that is neither its own part nor the `arm` itself."""
    if image.depth_m is None:
        return None
    own = np.asarray(cv2.dilate(segmentation.mask(room.part.name), _RIM))
    vs, us = np.nonzero((heights(image) > room.bottom_z + fit.tolerance_m) & (own == 0))
    points = unproject(image, us, vs)
    inside = _inside(points, room, fit)
    if arm:
        inside &= ~near(points, arm, clearance.arm_radius_m)
    area_px = int(np.count_nonzero(inside))
    if area_px < max(fit.fewest_px, fit.share * _floor_px(image, room)):
        return None
    middle = np.median(points[inside], axis=0)
    shown = segmentation.shown_at(us[inside], vs[inside])
    return Obstruction(
        position=(float(middle[0]), float(middle[1]), float(middle[2])),
        center=(float(np.median(us[inside])), float(np.median(vs[inside]))),
        area_px=area_px,
        what=f"{shown or 'something unknown'} is where {room.part.name} belongs",
    )


def _inside(points: Points, room: Room, fit: Fit) -> NDArray[np.bool_]:
    dx, dy = points[:, 0] - room.at.x, points[:, 1] - room.at.y
    cos, sin = math.cos(room.at.yaw), math.sin(room.at.yaw)
    half_x, half_y = (max(extent / 2 - fit.margin_m, 0.0) for extent in room.part.size[:2])
    top_z = room.bottom_z + _height_m(room.part) + fit.approach_m
    inside: NDArray[np.bool_] = (
        (np.abs(dx * cos + dy * sin) <= half_x)
        & (np.abs(dy * cos - dx * sin) <= half_y)
        & (points[:, 2] <= top_z)
    )
    return inside


def _height_m(part: Part) -> float:
    return part.size[2] + (0.0 if part.knob is None else part.knob[2])


def _floor_px(image: CameraImage, room: Room) -> float:
    """How many pixels the floor of a room would cover in the picture."""
    to_room = np.array([room.at.x, room.at.y, room.bottom_z]) - image.pose[:3, 3]
    distance_m = float(np.linalg.norm(to_room))
    slant = abs(float(to_room[2])) / distance_m
    area_m2 = room.part.size[0] * room.part.size[1]
    return area_m2 * slant * (image.focal_px / distance_m) ** 2
