"""Level surfaces: the tops of what stands on the table, told apart by height and by colour.

Pixels whose neighbourhood is level (a plane fitted to it hardly rises) are joined where neither
height nor colour steps from one to the next; then each surface grows over the rim that noise and
missing depth have eaten away.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from itertools import combinations

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.maps.compiled import compiled
from mend.robots.vision.height_map import HeightMap, Heights

Labels = NDArray[np.int32]
Pixels = NDArray[np.intp]

_LOWEST_M = 0.005
"""What rises less over the table is the table."""
_STEP_SIGMAS = 4.0
_SMALLEST_STEP_M = 0.002
_FEWEST_PX = 5
_GROWTH_PX = 3
_TABLE_STRIDE = 11
"""One in so many pixels of the table says well enough what its colour is."""
_LONGEST_PX = 200
_LOWER_SHARE = 0.3
"""Between pieces of one surface at most this share of what is higher may be lower."""
_LIKE = 14.0
"""Colours differ that are farther apart than this many grey levels and the noise's share."""
_NOISE_SHARE = 3.0


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """A level patch: its pixels with the rim, its height and what it looks like.

    `color` is the mean BGR of the pixels of its core. `pieces`: what it was joined of, if it was.
    """

    label: int
    us: Pixels
    vs: Pixels
    top_z: float
    core_px: int
    color: NDArray[np.float64]
    pieces: Sequence["Surface"] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Surfaces:
    """All level surfaces of a picture; `labels` (h, w) has each one's number, 0 elsewhere.

    `tolerance_m`: what is nearer to a surface's height than this belongs to it. `alike`: colours
    (grey levels) that are nearer to each other are the same.
    """

    all: Sequence[Surface]
    labels: Labels
    tolerance_m: float
    alike: float
    heights: HeightMap
    table_color: NDArray[np.float64]

    def with_pieces_apart(self, joined: Sequence[Surface]) -> "Surfaces":
        """The same with each of some surfaces taken for several, as many as it has pieces."""
        labels, gone = self.labels.copy(), {each.label for each in joined}
        pieces = [piece for each in joined for piece in each.pieces]
        for piece in pieces:
            labels[piece.vs, piece.us] = piece.label
        kept = [each for each in self.all if each.label not in gone]
        return replace(self, all=[*kept, *pieces], labels=labels)


def find_surfaces(seen: HeightMap) -> Surfaces:
    """All level surfaces above the table."""
    calm = np.asarray(cv2.medianBlur(seen.image.bgr, 3), np.uint8)
    alike = _LIKE + _NOISE_SHARE * _picture_noise(seen.image.bgr)
    step_m = max(_SMALLEST_STEP_M, _STEP_SIGMAS * 0.5 * seen.noise_m)
    tolerance_m = max(0.004, _STEP_SIGMAS * seen.noise_m)
    table = seen.image.bgr[seen.table_px][::_TABLE_STRIDE]
    table_color = np.median(table, axis=0) if len(table) else np.full(3, np.nan)

    lowest = seen.table_z + max(_LOWEST_M, _STEP_SIGMAS * seen.noise_m)
    smooth = _smooth_if_level(seen.height_m, seen.drop_m, np.float32(lowest))
    labels, count = _join(smooth, calm, np.float32(step_m), np.float32(alike))
    labels, cores = _without_specks(labels, count, smooth, calm)
    distinct = np.abs(cores.colors - table_color).max(axis=1) > alike
    for _ in range(_GROWTH_PX):
        labels = _grow(
            labels,
            seen.height_m,
            calm,
            cores.tops,
            cores.colors,
            distinct,
            np.float32(tolerance_m),
            np.float32(alike),
        )
    pixels = _pixels_by_label(labels, len(cores.tops))
    labels, groups = _join_pieces(labels, pixels, cores, seen, step_m, tolerance_m, alike)
    surfaces = _surfaces(groups, pixels, cores)
    return Surfaces(surfaces, labels, tolerance_m, alike, seen, table_color)


@dataclass(frozen=True, slots=True, eq=False)
class _Cores:
    """Height, colour and size in pixels of each label, the first that of label 1."""

    tops: NDArray[np.float64]
    colors: NDArray[np.float64]
    sizes: NDArray[np.int64]


def _without_specks(
    labels: Labels, count: int, smooth: Heights, calm: NDArray[np.uint8]
) -> tuple[Labels, _Cores]:
    """Labels numbered anew without those of too few pixels."""
    tops, colors, sizes = _describe(labels, count, smooth, calm)
    is_kept = sizes >= _FEWEST_PX
    is_kept[0] = False
    numbers = np.where(is_kept, np.cumsum(is_kept), 0).astype(np.int32)
    return numbers[labels], _Cores(tops[is_kept], colors[is_kept], sizes[is_kept])


def _join_pieces(
    labels: Labels,
    pixels: Sequence[tuple[Pixels, Pixels]],
    cores: _Cores,
    seen: HeightMap,
    step_m: float,
    tolerance_m: float,
    alike: float,
) -> tuple[Labels, list[list[int]]]:
    """Pieces of one surface that something in front of it has cut, and their common label.

    They are as high and of one colour, something higher is seen between them, and between no two
    of them anything lower. Those next to each other are joined first.
    """
    count = len(cores.tops)
    group = list(range(count))
    between = {
        (one, other): _between(pixels[one], pixels[other], cores.tops[one], seen, tolerance_m)
        for one, other in combinations(range(count), 2)
        if abs(cores.tops[one] - cores.tops[other]) <= step_m
        and np.abs(cores.colors[one] - cores.colors[other]).max() <= alike
    }
    cut = [pair for pair, found in between.items() if found is _Between.SOMETHING_HIGHER]
    for one, other in sorted(cut, key=lambda pair: _apart_px(pixels[pair[0]], pixels[pair[1]])):
        old, new = sorted((group[one], group[other]), reverse=True)
        both = combinations([each for each in range(count) if group[each] in (old, new)], 2)
        if not any(between.get(pair) is _Between.SOMETHING_LOWER for pair in both):
            group = [new if each == old else each for each in group]
    numbers = np.append(0, np.array(group, np.int64) + 1).astype(np.int32)
    groups = [[each for each in range(count) if group[each] == key] for key in sorted(set(group))]
    return numbers[labels], groups


class _Between(Enum):
    """What is seen between two pieces."""

    SOMETHING_HIGHER = auto()
    SOMETHING_LOWER = auto()
    NOTHING = auto()


def _apart_px(one: tuple[Pixels, Pixels], other: tuple[Pixels, Pixels]) -> float:
    """How far the middles of two pieces are from each other."""
    (us, vs), (other_us, other_vs) = one, other
    return math.hypot(us.mean() - other_us.mean(), vs.mean() - other_vs.mean())


def _between(
    one: tuple[Pixels, Pixels],
    other: tuple[Pixels, Pixels],
    top_z: float,
    seen: HeightMap,
    tolerance_m: float,
) -> _Between:
    us, vs = np.append(one[0], other[0]), np.append(one[1], other[1])
    left, top = int(us.min()), int(vs.min())
    if max(int(us.max()) - left, int(vs.max()) - top) > _LONGEST_PX:
        return _Between.NOTHING
    canvas = np.zeros((int(vs.max()) - top + 1, int(us.max()) - left + 1), np.uint8)
    # What stands on a piece, as a knob on its plate, is not between it and another one.
    for (some_us, some_vs), value in (((us, vs), 1), (one, 0), (other, 0)):
        hull = cv2.convexHull(np.stack([some_us - left, some_vs - top], axis=1).astype(np.int32))
        cv2.fillConvexPoly(canvas, hull, value)
    between = seen.height_m[top : top + canvas.shape[0], left : left + canvas.shape[1]][canvas > 0]
    with np.errstate(invalid="ignore"):
        higher = int(np.count_nonzero(between > top_z + tolerance_m))
        lower = int(np.count_nonzero(between < top_z - tolerance_m))
    if lower <= _LOWER_SHARE * higher:
        return _Between.SOMETHING_HIGHER if higher > 0 else _Between.NOTHING
    return _Between.SOMETHING_LOWER if lower >= _FEWEST_PX else _Between.NOTHING


def _surfaces(
    groups: Sequence[Sequence[int]], pixels: Sequence[tuple[Pixels, Pixels]], cores: _Cores
) -> list[Surface]:
    return [_surface(group, pixels, cores) for group in groups]


def _surface(
    group: Sequence[int], pixels: Sequence[tuple[Pixels, Pixels]], cores: _Cores
) -> Surface:
    sizes = cores.sizes[group].astype(np.float64)
    return Surface(
        group[0] + 1,
        np.concatenate([pixels[each][0] for each in group]),
        np.concatenate([pixels[each][1] for each in group]),
        float(np.average(cores.tops[group], weights=sizes)),
        int(sizes.sum()),
        np.asarray(np.average(cores.colors[group], axis=0, weights=sizes), np.float64),
        [_surface([each], pixels, cores) for each in group] if len(group) > 1 else (),
    )


def _picture_noise(bgr: NDArray[np.uint8]) -> float:
    """The standard deviation of a picture's noise in grey levels.

    Immerkaer, "Fast Noise Variance Estimation" (CVIU 1996), with the median in place of the mean
    so that edges do not count.
    """
    kernel = np.array([[1, -2, 1], [-2, 4, -2], [1, -2, 1]], np.float32)
    answer = np.abs(np.asarray(cv2.filter2D(bgr[::2, :, 1].astype(np.float32), -1, kernel)))
    return float(np.median(answer)) * 1.4826 / 6.0


def _pixels_by_label(labels: Labels, count: int) -> list[tuple[Pixels, Pixels]]:
    vs, us = np.nonzero(labels)
    numbers = labels[vs, us]
    order = np.argsort(numbers, kind="stable")
    ends = np.searchsorted(numbers[order], np.arange(1, count + 2))
    return [
        (us[order[ends[each] : ends[each + 1]]], vs[order[ends[each] : ends[each + 1]]])
        for each in range(count)
    ]


@compiled
def _smooth_if_level(height: Heights, drop: Heights, lowest: np.float32) -> Heights:
    """The height of the plane through each pixel's neighbours where that is level, else NaN.

    A plane that rises by more than half of what a vertical side would is not level. Neighbours
    that are a step apart belong to something else.
    """
    rows, columns = height.shape
    smooth = np.full((rows, columns), np.nan, np.float32)
    for v in range(1, rows - 1):
        for u in range(1, columns - 1):
            center = height[v, u]
            if not (center > lowest) or center > 5.0:
                continue
            most = 1.5 * drop[v, u]
            n, su, sv, sh, suu, svv, suv, suh, svh = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for dv in range(-1, 2):
                for du in range(-1, 2):
                    h = height[v + dv, u + du] - center
                    if not (abs(h) < most):
                        continue
                    n += 1
                    su += du
                    sv += dv
                    sh += h
                    suu += du * du
                    svv += dv * dv
                    suv += du * dv
                    suh += du * h
                    svh += dv * h
            if n < 5:
                continue
            cuu, cvv, cuv = suu - su * su / n, svv - sv * sv / n, suv - su * sv / n
            cuh, cvh = suh - su * sh / n, svh - sv * sh / n
            det = cuu * cvv - cuv * cuv
            if det < 1e-6:
                continue
            rise_u, rise_v = (cuh * cvv - cvh * cuv) / det, (cvh * cuu - cuh * cuv) / det
            if rise_u * rise_u + rise_v * rise_v < 0.25 * drop[v, u] * drop[v, u]:
                smooth[v, u] = center + (sh - rise_u * su - rise_v * sv) / n
    return smooth


@compiled
def _join(
    smooth: Heights, bgr: NDArray[np.uint8], step: np.float32, alike: np.float32
) -> tuple[Labels, int]:
    """Connected components of level pixels between which neither height nor colour steps."""
    rows, columns = smooth.shape
    labels = np.zeros((rows, columns), np.int32)
    parent = np.zeros(rows * columns // 2 + 2, np.int32)
    count = 0
    for v in range(rows):
        for u in range(columns):
            here = smooth[v, u]
            if np.isnan(here):
                continue
            found = 0
            for way in range(2):
                pv, pu = (v, u - 1) if way == 0 else (v - 1, u)
                if pv < 0 or pu < 0 or labels[pv, pu] == 0:
                    continue
                if abs(smooth[pv, pu] - here) > step:
                    continue
                apart = 0.0
                for c in range(3):
                    apart = max(apart, abs(float(bgr[v, u, c]) - float(bgr[pv, pu, c])))
                if apart > alike:
                    continue
                root = labels[pv, pu]
                while parent[root] != root:
                    root = parent[root]
                if found == 0:
                    found = root
                elif root != found:
                    parent[max(root, found)] = min(root, found)
                    found = min(root, found)
            if found == 0:
                count += 1
                parent[count] = count
                found = count
            labels[v, u] = found
    numbers = np.zeros(count + 1, np.int32)
    total = 0
    for label in range(1, count + 1):
        root = label
        while parent[root] != root:
            root = parent[root]
        if root == label:
            total += 1
            numbers[label] = total
        else:
            numbers[label] = numbers[root]
    for v in range(rows):
        for u in range(columns):
            labels[v, u] = numbers[labels[v, u]]
    return labels, total


@compiled
def _describe(
    labels: Labels, count: int, smooth: Heights, bgr: NDArray[np.uint8]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Mean height, mean colour and size in pixels of each label; the first is nobody's."""
    tops, colors = np.zeros(count + 1), np.zeros((count + 1, 3))
    sizes = np.zeros(count + 1, np.int64)
    rows, columns = labels.shape
    for v in range(rows):
        for u in range(columns):
            label = labels[v, u]
            if label == 0:
                continue
            sizes[label] += 1
            tops[label] += smooth[v, u]
            for c in range(3):
                colors[label, c] += bgr[v, u, c]
    for label in range(1, count + 1):
        tops[label] /= sizes[label]
        for c in range(3):
            colors[label, c] /= sizes[label]
    return tops, colors, sizes


@compiled
def _grow(
    labels: Labels,
    height: Heights,
    bgr: NDArray[np.uint8],
    tops: NDArray[np.float64],
    colors: NDArray[np.float64],
    distinct: NDArray[np.bool_],
    tolerance: np.float32,
    alike: np.float32,
) -> Labels:
    """Each surface one pixel wider, where height allows it; without depth, where colour does.

    A pixel between two goes to the one whose colour is nearer.
    """
    rows, columns = labels.shape
    grown = labels.copy()
    for v in range(1, rows - 1):
        for u in range(1, columns - 1):
            if labels[v, u] != 0:
                continue
            nearest = 1e9
            for way in range(4):
                pv = v + (way == 0) - (way == 1)
                pu = u + (way == 2) - (way == 3)
                label = labels[pv, pu]
                if label == 0:
                    continue
                apart = 0.0
                for c in range(3):
                    apart = max(apart, abs(colors[label - 1, c] - float(bgr[v, u, c])))
                has_depth = not np.isnan(height[v, u])
                if has_depth and abs(height[v, u] - tops[label - 1]) > tolerance:
                    continue
                if not has_depth and (apart > alike or not distinct[label - 1]):
                    continue
                if apart < nearest:
                    nearest = apart
                    grown[v, u] = label
    return grown
