"""Where a person may lay an object down without putting it on top of another."""

import math

import numpy as np

from mend.tasks.scene import Pose, Scene

PLACE_RADIUS_M = 0.06
"""What is kept clear around a place, whatever belongs there."""
_TRIES = 100


def free_pose(handled: str, scene: Scene, rng: np.random.Generator) -> Pose | None:
    """A pose on the table for an object, clear of all start poses and places.

    None if chance finds none.
    """
    own_m = radius_m(handled, scene)
    taken = [
        (each.pose, own_m + radius_m(name, scene))
        for name, each in scene.objects.items()
        if name != handled
    ]
    taken += [(place.pose, own_m + PLACE_RADIUS_M) for place in scene.places.values()]
    half_x, half_y = (extent / 2 - own_m for extent in scene.table.size)
    if half_x < 0 or half_y < 0:
        return None
    for _ in range(_TRIES):
        pose = Pose(
            x=scene.table.center[0] + float(rng.uniform(-half_x, half_x)),
            y=scene.table.center[1] + float(rng.uniform(-half_y, half_y)),
        )
        if all(math.hypot(pose.x - at.x, pose.y - at.y) > clear_m for at, clear_m in taken):
            return pose
    return None


def radius_m(name: str, scene: Scene) -> float:
    """The radius of the upright cylinder around an object, however it is turned."""
    length, width, _ = scene.objects[name].size
    return math.hypot(length, width) / 2
