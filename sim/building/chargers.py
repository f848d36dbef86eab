"""Where robots are charged."""

import math

from mend.maps.building.building import Building, PlaceKind

AT_CHARGER_M = 0.3
"""Who is so near to a charger touches its contacts."""


def is_at_charger(building: Building, floor: str, x: float, y: float) -> bool:
    """Whether a robot there touches the contacts of a charger; in a cabin there is none."""
    if floor not in building.floors:
        return False
    return any(
        each.kind is PlaceKind.CHARGER and math.hypot(each.x - x, each.y - y) <= AT_CHARGER_M
        for each in building.floors[floor].places.values()
    )
