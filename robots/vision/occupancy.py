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
from robots.vision.head import HeadSighting
from robots.vision.obstruction import Clearance, Obstruction, Segment, near
from robots.vision.projection import Points, heights, pixels_covered, unproject

_RIM = np.ones((5, 5), np.uint8)
"""Colours mix at a part's rim; so much wider it hides none of what is beside it."""

_COVERED_SHARE = 0.7
"""Something covers a part of whose top less than this is seen."""


@dataclass(frozen=True, slots=True)
class Room:
    """The room that `part` takes at a place: upright, with its bottom at `bottom_z`.

    `meaning` says what it is when something else is there. `around_m` is looked at beside it.
    """

    part: Part
    at: Location
    bottom_z: float
    meaning: str
    around_m: float = 0.0


def room_at_place(part: Part, target: Location, bottom_z: float) -> Room:
    """Where a part is to go."""
    return Room(part, target, bottom_z, f"is where {part.name} belongs")


def room_above(part: Part, sighting: HeadSighting) -> Room:
    """What has to be free over a part for the fingers to take it."""
    at = Location(x=sighting.x, y=sighting.y, z=sighting.top_z, yaw=sighting.yaw)
    # Of a part that is half covered the other half was measured: what covers it is beside that.
    around_m = 0.0 if sighting.shown >= _COVERED_SHARE else min(part.size[:2]) / 2
    return Room(part, at, sighting.top_z, f"lies on {part.name}", around_m)


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
    """What is in `room` that is neither its part nor the `arm` itself."""
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
        what=f"{shown or 'something unknown'} {room.meaning}",
    )


def _inside(points: Points, room: Room, fit: Fit) -> NDArray[np.bool_]:
    dx, dy = points[:, 0] - room.at.x, points[:, 1] - room.at.y
    cos, sin = math.cos(room.at.yaw), math.sin(room.at.yaw)
    half_x, half_y = (
        max(extent / 2 - fit.margin_m, 0.0) + room.around_m for extent in room.part.size[:2]
    )
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
    at = (room.at.x, room.at.y, room.bottom_z)
    return pixels_covered(image, at, room.part.size[:2])
