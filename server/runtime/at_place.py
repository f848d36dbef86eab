"""Whether an object was seen at its place: in the plane, and not on top of something there."""

import math

from robots.link.messages import Sighting
from tasks.scene import Place, Scene

HEIGHT_TOLERANCE_M = 0.03
"""An object that is this much too high or too low lies on something else, or fell."""


def is_at_place(seen: Sighting, place: Place, scene: Scene, within_m: float) -> bool:
    """Whether a sighting is within `within_m` of a place of a scene, at its height."""
    height_m = scene.table.height if place.pose.z is None else place.pose.z
    distance_m = math.hypot(seen.x - place.pose.x, seen.y - place.pose.y)
    return distance_m <= within_m and abs(seen.z - height_m) <= HEIGHT_TOLERANCE_M
