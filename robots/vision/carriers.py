"""What parts stand on that no camera can tell: of a stack only what is on top has a top to see."""

from collections.abc import Sequence
from dataclasses import replace

import shapely

from mend.robots.vision.seen_box import SeenBox

_HELD_UP_M = 0.01
"""What is so near to something's top is held up by it."""


def below(box: SeenBox, table_z: float) -> SeenBox:
    """The room from a box down to the table."""
    size = (*box.size[:2], box.bottom_z - table_z)
    name = f"what {box.name or 'something unknown'} stands on"
    return replace(box, size=size, bottom_z=table_z, name=name, complete=False)


def unseen_carriers(boxes: Sequence[SeenBox], table_z: float) -> list[SeenBox]:
    """What must be below those of the known boxes that nothing seen holds up."""
    high = [each for each in boxes if each.name and each.bottom_z > table_z + _HELD_UP_M]
    return [below(box, table_z) for box in high if not any(_holds_up(o, box) for o in boxes)]


def bears(box: SeenBox, spot: tuple[float, float, float], radius_m: float) -> bool:
    """Whether what stands there (its bottom's middle), and is so wide, may rest on a box."""
    x, y, z = spot
    apart_m = shapely.Polygon(box.corners()).distance(shapely.Point(x, y))
    return abs(box.top_z - z) <= _HELD_UP_M and apart_m < radius_m


def _holds_up(lower: SeenBox, box: SeenBox) -> bool:
    if lower is box or abs(lower.top_z - box.bottom_z) > _HELD_UP_M:
        return False
    outlines = [shapely.Polygon(each.corners()) for each in (lower, box)]
    return bool(outlines[0].intersects(outlines[1]))
