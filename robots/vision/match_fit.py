"""Where exactly a part's top is, once it is known which part a surface belongs to.

The rectangle then has the part's own extents; what is not seen of it is told by where the part
stood, or by what it carries.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely

from mend.robots.link.messages import Location
from mend.robots.vision.evidence import Evidence, gather_under
from mend.robots.vision.level_rectangle import Rectangle
from mend.robots.vision.level_surfaces import Surfaces
from mend.robots.vision.naming import Match, Top
from mend.robots.vision.rectangle import Fitted, fit_sized, fit_with_knob
from mend.tasks.part_boxes import Size

_TURNS_RAD = (math.pi / 4, math.pi / 2, -math.pi / 4)
_SMALL_PX = 10.0
_QUARTERS_RAD = (0.0, math.pi / 2)
_AS_WELL = 1.2
"""A rectangle fits a half hidden surface as well as another if its misfit is not larger by more."""

_OF_SEEN = 0.8
"""A rectangle that explains a surface holds so much of it, at least, as one that fits best."""


def fit_match(
    match: Match, surfaces: Surfaces, stood: Location | None, carried: Sequence[Rectangle]
) -> Fitted:
    """Where exactly the surface is, now that its size is known.

    `stood`: where the part was when last seen whole; `carried`: what stands on the surface.
    """
    rough = match.top.fitted.turned() if match.swapped else match.top.fitted
    at = rough.rectangle
    # What is hidden goes on from the end that is seen.
    hidden = np.array(match.extents) - at.extents
    shifts = [
        hidden[axis] / 2 * (int(low) - int(high))
        for axis, (low, high) in enumerate((rough.sides_seen[:2], rough.sides_seen[2:]))
    ]
    start = Rectangle(*at.point(*shifts), at.yaw, match.extents)
    if match.upright and match.part.knob is not None and (knob := match.knob) is not None:
        return _fit_with_knob(knob, match.part.size, match.part.knob, start, surfaces)
    evidence, starts = match.top.evidence, [start]
    if all(rough.sides_seen) and min(match.extents) < _SMALL_PX * evidence.pixel_m:
        # A rectangle of a few pixels, fitted without its size, may lie any way round.
        starts += [replace(start, yaw=at.yaw + turn) for turn in _TURNS_RAD]
    best = fit_sized(evidence, starts)
    if all(rough.sides_seen):
        return best
    # Of a corner that is seen the rest may lie either way: it stands as it did if that fits, too.
    if stood is not None and _is_so_high(match, stood, surfaces):
        still = fit_sized(evidence, [Rectangle(stood.x, stood.y, stood.yaw, match.extents)])
        # Of a small piece far from there nearly as little is left over, explained or not.
        explains = still.shown >= _OF_SEEN * best.shown and still.shown > 0.0
        return still if explains and still.misfit <= _AS_WELL * best.misfit else best
    return _fit_under(carried, evidence, best) if carried else best


def carried_by(match: Match, matches: Sequence[Match], tolerance_m: float) -> list[Rectangle]:
    """What stands on a half hidden surface, by what was seen of it so far."""
    top = match.top
    if all(top.fitted.sides_seen):
        return []
    reach = top.fitted.outline(max(match.extents))
    return [
        each.top.fitted.rectangle
        for each in matches
        if abs(each.top.surface.top_z - each.height_m - top.surface.top_z) <= 2 * tolerance_m
        and reach.contains(shapely.Point(each.top.fitted.rectangle.x, each.top.fitted.rectangle.y))
    ]


def _fit_under(carried: Sequence[Rectangle], evidence: Evidence, best: Fitted) -> Fitted:
    """Of what fits as well as `best`, that which has what it carries nearest to its middle."""
    x, y = (sum(each) / len(carried) for each in zip(*((c.x, c.y) for c in carried), strict=True))
    under = replace(best.rectangle, x=x, y=y)
    turned = replace(under, yaw=under.yaw + math.pi / 2)
    fits = [best, *(fit_sized(evidence, [start]) for start in (under, turned))]
    least = min(each.misfit for each in fits)
    return min(
        (each for each in fits if each.misfit <= _AS_WELL * least),
        key=lambda each: math.hypot(each.rectangle.x - x, each.rectangle.y - y),
    )


def _fit_with_knob(
    knob: Top, size: Size, on_top: Size, rough: Rectangle, surfaces: Surfaces
) -> Fitted:
    """One pose for a plate and its knob; where the knob is square the plate's rim says which."""
    on = knob.fitted.rectangle
    starts = [Rectangle(on.x, on.y, on.yaw + turn, size[:2]) for turn in _QUARTERS_RAD]
    starts.append(replace(rough, extents=size[:2]))
    plate = gather_under(knob.surface, knob.surface.top_z - on_top[2], starts, surfaces)
    return fit_with_knob(plate, knob.evidence, starts, on_top[:2])


def _is_so_high(match: Match, stood: Location, surfaces: Surfaces) -> bool:
    """Whether a surface is as high as the part's top was."""
    if not match.upright or stood.z is None:
        return False
    off_m = stood.z + match.height_m - match.top.surface.top_z
    return abs(off_m) <= 2 * surfaces.tolerance_m
