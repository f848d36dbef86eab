"""Which part each level surface is the top of: one assignment for the whole picture.

Every surface is compared with every part in each of the ways in which it can lie; the cheapest
matching (Kuhn's Hungarian method) names them, and a surface may stay unknown. A cost is half a
sum of squares of deviations in units of their standard deviations.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from mend.robots.catalogue import Part
from mend.robots.vision.color_model import ColorModel, Segmentation, tint_sigma
from mend.robots.vision.evidence import Evidence
from mend.robots.vision.level_rectangle import Rectangle
from mend.robots.vision.level_surfaces import Surface, Surfaces
from mend.robots.vision.rectangle import Fitted
from mend.robots.vision.tracking import Spot
from mend.tasks.part_boxes import Size

Costs = NDArray[np.float64]

UNKNOWN_COST = 25.0
_NEVER = 1e6
_HEIGHT_SIGMA_M = 0.0012
_EXTENT_SIGMA_PX = 0.45
_FLOATING_COST = 10.0
"""What is held up by nothing that is seen may be held by somebody, or lean."""
_TOPPLED_COST = 4.0
_SURELY_TOPPLED = math.log(99.0)
"""It stands unless it has toppled with this log odds."""
_KNOB_UNSEEN_COST = 8.0
_MOST_COLOR_COST = 40.0
_MOST_SHARE_COST = 4.0
_OVEREXPOSED = 250.0
_KNOB_WITHIN_M = 0.005
_MOST_HIDDEN_M = 0.1
_LEAST_HIGHER_M = 0.005
_TRACKING_COST = 2.0
_TRACKED_WITHIN_M = 0.05
"""Among equals a name costs nothing where it was last, and this much from so far away on."""
_WANTED_COST = -0.5
"""What is brought back among equals is the one that is wanted, if that is gone as well."""


@dataclass(frozen=True, slots=True, eq=False)
class Top:
    """A surface as it was measured, with the knob that stands on it if there is one."""

    surface: Surface
    evidence: Evidence
    fitted: Fitted
    knob: "Top | None" = None


@dataclass(frozen=True, slots=True)
class Match:
    """A surface taken for a part.

    `height_m` from the part's bottom to this surface, `extents` of this surface along the part's
    x and y axes, `swapped` if these are the surface's second and first.
    """

    top: Top
    part: Part
    height_m: float
    extents: tuple[float, float]
    swapped: bool
    upright: bool

    @property
    def knob(self) -> Top | None:
        """The part's knob, where it is seen."""
        by_knob_alone = self.upright and self.height_m > self.part.size[2]
        return self.top if by_knob_alone else self.top.knob


@dataclass(frozen=True, slots=True)
class _TopOfPart:
    """One way in which a part can show a level top."""

    part: Part
    extents: tuple[float, float]
    height_m: float
    cost: float
    upright: bool
    with_knob: bool = False


class Namer:
    """Names surfaces after the parts of a catalogue."""

    def __init__(self, parts: Mapping[str, Part], model: ColorModel) -> None:
        self._parts = list(parts.values())
        self._model = model
        self._ways = [way for part in self._parts for way in _ways_of(part)]
        without = (math.nan,) * 3
        self._tints = np.array([model.tints.get(part.name, without) for part in self._parts])
        self._extents = np.array([way.extents for way in self._ways])
        self._heights = np.array([way.height_m for way in self._ways])
        self._base = np.array([way.cost for way in self._ways])
        self._lying = np.array([not way.upright for way in self._ways])
        self._knobbed = np.array([way.with_knob for way in self._ways])
        self._knob_extents = np.array([(way.part.knob or way.part.size)[:2] for way in self._ways])
        owners = {part.name: index for index, part in enumerate(self._parts)}
        self._owner = np.array([owners[way.part.name] for way in self._ways])

    def name(
        self,
        tops: Sequence[Top],
        surfaces: Surfaces,
        segmentation: Segmentation,
        last_seen: Mapping[str, Spot],
        wanted: str | None = None,
    ) -> tuple[list[Match], list[Top]]:
        """The parts that are seen, and what stays unknown.

        `last_seen` is where each name was last; names of equal parts go by that, and then by which
        of them is `wanted`.
        """
        tops = self._with_knobs(tops, surfaces)
        if not tops or not self._ways:
            return [], list(tops)
        pixel_m = surfaces.heights.drop_m
        costs = np.empty((len(tops), len(self._parts) + len(tops)))
        costs[:, len(self._parts) :] = _NEVER
        choices: list[tuple[NDArray[np.intp], NDArray[np.bool_]]] = []
        for row, (top, supports) in enumerate(zip(tops, _supports(tops, surfaces), strict=True)):
            at = pixel_m[top.surface.vs[0], top.surface.us[0]]
            by_way, swapped = self._geometry_costs(top, supports, float(at))
            chosen = np.empty(len(self._parts), np.intp)
            less_surely = by_way + np.where(self._lying, _SURELY_TOPPLED, 0.0)
            for index in range(len(self._parts)):
                ways = np.flatnonzero(self._owner == index)
                chosen[index] = ways[less_surely[ways].argmin()]
            costs[row, : len(self._parts)] = by_way[chosen]
            costs[row, : len(self._parts)] += self._tint_costs(top.surface, surfaces.table_color)
            for index in np.flatnonzero(costs[row, : len(self._parts)] < UNKNOWN_COST).tolist():
                name = self._parts[index].name
                costs[row, index] += self._hue_cost(name, top.surface, segmentation)
                bottom_z = top.surface.top_z - float(self._heights[chosen[index]])
                costs[row, index] += _tracking_cost(top, bottom_z, last_seen.get(name))
                costs[row, index] += _WANTED_COST if name == wanted else 0.0
            costs[row, len(self._parts) + row] = UNKNOWN_COST
            choices.append((chosen, swapped))
        matches, unknown = [], []
        for row, column in zip(*linear_sum_assignment(costs), strict=True):
            if column >= len(self._parts) or costs[row, column] >= UNKNOWN_COST:
                unknown.append(tops[row])
                continue
            chosen, swapped = choices[row]
            way = self._ways[chosen[column]]
            matches.append(
                Match(
                    tops[row],
                    way.part,
                    way.height_m,
                    way.extents,
                    bool(swapped[chosen[column]]),
                    way.upright,
                )
            )
        return matches, unknown

    def _with_knobs(self, tops: Sequence[Top], surfaces: Surfaces) -> list[Top]:
        """What has a knob's size and place on a plate is that plate's knob.

        Where an end of the plate is hidden the knob may name the part better by itself.
        """
        knob_of: dict[int, Top] = {}
        taken: set[int] = set()
        for row, column in zip(*np.nonzero(self._may_be_knobs(tops, surfaces)), strict=True):
            plate, other = tops[row], tops[column]
            if not self._is_knob(other, plate, surfaces):
                continue
            knob_of[id(plate)] = other
            if all(plate.fitted.whole):
                taken.add(id(other))
        return [replace(each, knob=knob_of.get(id(each))) for each in tops if id(each) not in taken]

    def _may_be_knobs(self, tops: Sequence[Top], surfaces: Surfaces) -> NDArray[np.bool_]:
        """Of each pair of tops whether the second one may be a knob on the first one.

        There may be hundreds of tops where an arm is in the picture.
        """
        rises_m = np.array([part.knob[2] for part in self._parts if part.knob is not None])
        if not tops or not len(rises_m):
            return np.zeros((len(tops), len(tops)), np.bool_)
        heights = np.array([each.surface.top_z for each in tops])
        colors = np.array([each.surface.color for each in tops])
        rise_m = (heights[None] - heights[:, None])[..., None]
        rises = (np.abs(rise_m - rises_m) <= surfaces.tolerance_m).any(axis=-1)
        differs = np.abs(colors[None] - colors[:, None]).max(axis=-1) > surfaces.alike
        return np.asarray(rises & ~differs & ~np.eye(len(tops), dtype=np.bool_), np.bool_)

    def _is_knob(self, knob: Top, plate: Top, surfaces: Surfaces) -> bool:
        """Whether one surface stands on another as some part's knob stands on its plate."""
        on, under = knob.fitted.rectangle, plate.fitted.rectangle
        apart_m, whole = math.hypot(on.x - under.x, on.y - under.y), all(plate.fitted.whole)
        if np.abs(knob.surface.color - plate.surface.color).max() > surfaces.alike:
            return False
        rise_m = knob.surface.top_z - plate.surface.top_z
        return any(
            abs(rise_m - part.knob[2]) <= surfaces.tolerance_m
            and apart_m <= (_KNOB_WITHIN_M if whole else math.hypot(*part.size[:2]) / 2)
            and _can_measure(knob, part.knob)
            and _can_measure(plate, part.size)
            for part in self._parts
            if part.knob is not None
        )

    def _geometry_costs(
        self, top: Top, supports: NDArray[np.float64], drop_m: float
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        sigma_m = _EXTENT_SIGMA_PX * drop_m * 0.6 + 0.0003
        seen, whole = np.array(top.fitted.rectangle.extents), np.array(top.fitted.whole)
        knobs = self._knob_extents if top.knob is not None else None
        costs = []
        for order in ([0, 1], [1, 0]):
            off = (seen[None] - self._extents[:, order]) / sigma_m
            # Where an end is hidden the part may be longer than what is seen of it.
            off = np.where(whole[None] | (off > 0), off, 0.0)
            cost = 0.5 * (off**2).sum(axis=1)
            if knobs is not None:
                off = (_knob_along(top) - knobs[:, order]) / (2 * sigma_m)
                cost += np.where(self._knobbed, 0.5 * (off**2).sum(axis=1), 0.0)
            costs.append(cost)
        straight, crossed = costs
        bottoms = top.surface.top_z - self._heights
        gap = np.abs(bottoms[:, None] - supports[None]).min(axis=1) / _HEIGHT_SIGMA_M
        height = np.minimum(0.5 * gap**2, _FLOATING_COST)
        # Nothing is under the table.
        height[bottoms < supports.min() - 4 * _HEIGHT_SIGMA_M] = _NEVER
        knob = np.where(self._knobbed != (top.knob is not None), _KNOB_UNSEEN_COST, 0.0)
        total = np.minimum(straight, crossed) + height + knob + self._base
        return total, crossed < straight

    def _tint_costs(self, surface: Surface, reference: NDArray[np.float64]) -> Costs:
        """How unlike a surface's colour is each part's, as seen over the table's."""
        usable = (surface.color < _OVEREXPOSED) & (reference < _OVEREXPOSED)
        if not np.isfinite(reference).all() or not usable.any():
            return np.zeros(len(self._parts))
        seen = surface.color / np.maximum(reference, 1.0)
        off = ((seen - self._tints) / tint_sigma(seen))[:, usable]
        # A part that was learned without a table to compare with has no tint.
        costs = np.minimum(0.5 * (off**2).sum(axis=1), _MOST_COLOR_COST)
        return np.asarray(np.nan_to_num(costs, nan=0.0))

    def _hue_cost(self, name: str, surface: Surface, segmentation: Segmentation) -> float:
        if not self._model.has_hue(name):
            return 0.0
        share = segmentation.share(name, surface.us, surface.vs)
        return min(-math.log(share + 0.02), _MOST_SHARE_COST)


def _can_measure(top: Top, size: Size) -> bool:
    """Whether a surface can be the top of a box of some size, as far as its ends are seen."""
    for straight in (True, False):
        extents = size[:2] if straight else size[1::-1]
        pairs = zip(top.fitted.rectangle.extents, extents, top.fitted.whole, strict=True)
        if all(
            seen <= side + _KNOB_WITHIN_M and (not whole or seen >= side - _KNOB_WITHIN_M)
            for seen, side, whole in pairs
        ):
            return True
    return False


def _knob_along(top: Top) -> NDArray[np.float64]:
    """The extents of a plate's knob along the plate's axes."""
    if top.knob is None:
        raise ValueError("expected a top with a knob")
    knob, plate = top.knob.fitted.rectangle, top.fitted.rectangle
    crossed = abs(math.sin(knob.yaw - plate.yaw)) > math.sqrt(0.5)
    return np.array(knob.extents[::-1] if crossed else knob.extents)


def _ways_of(part: Part) -> list[_TopOfPart]:
    x, y, z = part.size
    ways = [_TopOfPart(part, (x, y), z, 0.0, True, part.knob is not None)]
    if part.knob is not None:
        height_m = z + part.knob[2]
        ways.append(_TopOfPart(part, part.knob[:2], height_m, _KNOB_UNSEEN_COST, True))
    ways.append(_TopOfPart(part, (x, z), y, _TOPPLED_COST, False))
    ways.append(_TopOfPart(part, (z, y), x, _TOPPLED_COST, False))
    return ways


def _supports(tops: Sequence[Top], surfaces: Surfaces) -> list[NDArray[np.float64]]:
    """For each top the heights on which a part can stand there: the table's, and lower tops'.

    Tops of which an end is hidden may reach under one another though that is not seen.
    """
    outlines = [each.fitted.outline(_MOST_HIDDEN_M) for each in tops]
    heights = np.array([each.surface.top_z for each in tops])
    lower = heights < heights[:, np.newaxis] - _LEAST_HIGHER_M
    meeting = np.zeros_like(lower)
    meeting[tuple(shapely.STRtree(outlines).query(outlines, predicate="intersects"))] = True
    return [np.array([surfaces.heights.table_z, *heights[each]]) for each in lower & meeting]


def _tracking_cost(top: Top, bottom_z: float, last: Spot | None) -> float:
    if last is None:
        return _TRACKING_COST / 2
    at: Rectangle = top.fitted.rectangle
    moved_m = math.dist((at.x, at.y, bottom_z), last)
    return _TRACKING_COST * min(moved_m / _TRACKED_WITHIN_M, 1.0)
