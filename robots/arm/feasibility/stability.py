"""How far what stands may lean before it tips over: the angle of static stability."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from mend.robots.arm.feasibility.standing import Standing, beneath

PLACED_WITHIN_M = 0.003
"""So far a part may be beside where it is to stand on another one."""


def stability_rad(
    standing: Standing,
    carriers: Sequence[Standing],
    others: Sequence[Standing],
    mass_kg: Mapping[str, float],
) -> float:
    """By how much a part may lean, with all that only it carries, before it tips over.

    Negative for what would tip over at once. `carriers` is what it stands on (nothing: the table),
    `others` what else stands there, `mass_kg` what each weighs.
    """
    base: BaseGeometry = standing.ground
    spare_m = 0.0
    if carriers:
        touching = [each.ground.intersection(standing.ground) for each in carriers]
        base = shapely.union_all(touching).convex_hull
        spare_m = PLACED_WITHIN_M
    x, y, z = _center_of_mass([standing, *carried_by(standing, others)], mass_kg)
    middle = shapely.Point(x, y)
    beside_m = float(base.boundary.distance(middle))
    inside_m = beside_m if base.contains(middle) else -beside_m
    return math.atan2(inside_m - spare_m, z - standing.bottom_z)


def carried_by(standing: Standing, others: Sequence[Standing]) -> Iterator[Standing]:
    """What stands on a part alone, and on that."""
    for each in others:
        if not beneath(each, [standing]):
            continue
        if all(below.where == standing.where for below in beneath(each, others)):
            yield each
            yield from carried_by(each, others)


def _center_of_mass(group: Sequence[Standing], mass_kg: Mapping[str, float]) -> tuple[float, ...]:
    """Of parts that are as heavy everywhere."""
    weighted = []
    for each in group:
        volumes = np.array([math.prod(box.size) for box in each.boxes])
        heights = np.array([(box.bottom_z + box.top_z) / 2 for box in each.boxes])
        z = float(np.average(heights, weights=volumes))
        weighted.append((each.pose.x, each.pose.y, z, mass_kg[each.name]))
    values = np.array(weighted)
    return tuple(np.average(values[:, :3], axis=0, weights=values[:, 3]).tolist())
