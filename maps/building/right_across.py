"""What would stand right across a lane, from wall to wall."""

import math

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Floor, Lane
from mend.maps.ray_cast import NOTHING, cast

Matrix = NDArray[np.float64]

REACH_M = 4.0
"""Things are put across a corridor from wall to wall, as far as it is no wider than twice this."""


def right_across(floor: Floor, lane: Lane) -> tuple[Matrix, bool]:
    """A segment (1, 4) through the middle of a lane, and whether it ends at walls."""
    a, b = (floor.places[each] for each in lane.between)
    x, y = (a.x + b.x) / 2.0, (a.y + b.y) / 2.0
    aside = math.atan2(b.y - a.y, b.x - a.x) + math.pi / 2.0
    directions = np.array([aside, aside + math.pi])
    ways_m, walls = cast(floor.wall_segments, x, y, directions, REACH_M)
    ends = [
        (x + away_m * math.cos(angle), y + away_m * math.sin(angle))
        for away_m, angle in zip(ways_m, directions, strict=True)
    ]
    return np.array([[*ends[0], *ends[1]]]), bool((walls != NOTHING).all())
