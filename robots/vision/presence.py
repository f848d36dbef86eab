"""Whether a part is still where it was put, as far as a picture can tell."""

import math
from enum import StrEnum

from robots.link.messages import Location
from robots.vision.head import HeadSighting

AT_PLACE_M = 0.02
"""A part is at its place if it is this near to it."""
AT_PLACE_HEIGHT_M = 0.015


class Presence(StrEnum):
    """What a picture says of a part at a place."""

    THERE = "there"
    """It is seen at its place."""
    GONE = "gone"
    """Its place is seen, and it is not there."""
    HIDDEN = "hidden"
    """Something in front of its place keeps the camera from telling."""


def is_at(sighting: HeadSighting, target: Location, target_z: float) -> bool:
    """Whether an object rests where it is to be."""
    near = math.hypot(sighting.x - target.x, sighting.y - target.y) <= AT_PLACE_M
    return near and abs(sighting.z - target_z) <= AT_PLACE_HEIGHT_M
