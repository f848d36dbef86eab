"""Whether something round touches any wall."""

import math
from typing import Any

from mend.maps.compiled import compiled


@compiled
def touches_any(segments: Any, x: float, y: float, radius_m: float) -> bool:
    """Whether any of segments (n, 4) comes nearer than `radius_m` to a point."""
    for number in range(segments.shape[0]):
        x0, y0 = segments[number, 0], segments[number, 1]
        along_x, along_y = segments[number, 2] - x0, segments[number, 3] - y0
        off_x, off_y = x - x0, y - y0
        length = max(along_x * along_x + along_y * along_y, 1e-12)
        share = min(max((off_x * along_x + off_y * along_y) / length, 0.0), 1.0)
        if math.hypot(off_x - share * along_x, off_y - share * along_y) < radius_m:
            return True
    return False
