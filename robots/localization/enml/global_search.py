"""Where on a map, or on a part of it, some points fit: the best places of a coarse lattice."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from maps.compiled import compiled
from robots.localization.enml.problem import Floats
from robots.localization.mcl.likelihood_field import DistanceField
from robots.localization.pose import Poses, wrap

Grid = NDArray[np.float32]

_COARSE_M = 0.4
_COARSE_WIDTH_M = 0.35
_HEADINGS = 60
_COARSE_POINTS = 40
_FINE_WIDTH_M = 0.15
_FINE_STEPS = ((0.2, np.radians(3.0)), (0.1, np.radians(1.5)), (0.05, np.radians(0.75)))
_APART_M = 0.7
_APART_RAD = np.radians(15.0)


@dataclass(frozen=True, slots=True)
class Region:
    """A rectangle of the map (metres): where to look."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    @classmethod
    def around(cls, pose: Poses, reach_m: float) -> "Region":
        """The square around a pose."""
        x, y = float(pose[0]), float(pose[1])
        return cls(x - reach_m, y - reach_m, x + reach_m, y + reach_m)


def best_places(field: DistanceField, points: Floats, region: Region, count: int) -> list[Poses]:
    """At most so many poses within a region at which points (robot's frame) fit, best first.

    They are some way apart from each other, and refined to a few centimetres.
    """
    if not len(points):
        return []
    coarse = points[_spread(len(points), _COARSE_POINTS)]
    xs = np.arange(region.x_min, region.x_max + _COARSE_M, _COARSE_M)
    ys = np.arange(region.y_min, region.y_max + _COARSE_M, _COARSE_M)
    headings = np.linspace(0.0, 2.0 * np.pi, _HEADINGS, endpoint=False)
    fit = fits(field, _COARSE_WIDTH_M)
    scores = np.zeros((len(headings), len(ys), len(xs)), dtype=np.float32)
    score_places(fit, field.origin, field.cell_m, coarse, headings, xs, ys, scores)
    candidates = _peaks(scores, headings, xs, ys, 8 * count)
    fine = fits(field, _FINE_WIDTH_M)
    refined = np.empty((len(candidates), 4))
    for row, candidate in enumerate(candidates):
        pose = candidate.copy()
        score = 0.0
        for step_m, step_rad in _FINE_STEPS:
            score = refine(fine, field.origin, field.cell_m, points, pose, step_m, step_rad)
        refined[row, :3], refined[row, 3] = pose, score
    return _distinct(refined[np.argsort(-refined[:, 3], kind="stable")], count)


def _spread(count: int, wanted: int) -> NDArray[np.int64]:
    return np.unique(np.linspace(0, count - 1, min(count, wanted)).astype(np.int64))


def fits(field: DistanceField, width_m: float) -> Grid:
    """How well a point fits at each corner of the field: 1 on a wall, nearly 0 far from it."""
    fit = np.exp(-0.5 * (field.distances / width_m) ** 2).astype(np.float32)
    fit[field.distances >= field.reach_m] = 0.0
    return np.asarray(fit)


def _peaks(scores: Grid, headings: Floats, xs: Floats, ys: Floats, count: int) -> list[Poses]:
    """The places with the highest scores, of neighbours only the best."""
    best_heading = scores.argmax(axis=0)
    best = scores.max(axis=0)
    found: list[Poses] = []
    # The best heading of each place, and the best elsewhere on the circle for those that look
    # the same both ways, as corridors do.
    opposite = (best_heading + _HEADINGS // 2) % _HEADINGS
    rows, columns = np.indices(best.shape)
    turned = np.stack([scores[(opposite + d) % _HEADINGS, rows, columns] for d in range(-8, 9)])
    for values, choice in (
        (best, best_heading),
        (turned.max(axis=0), (opposite + turned.argmax(axis=0) - 8) % _HEADINGS),
    ):
        order = np.argsort(-values, axis=None, kind="stable")[:count]
        for at in order:
            row, column = np.unravel_index(int(at), values.shape)
            found.append(np.array([xs[column], ys[row], headings[choice[row, column]]]))
    return found


def _distinct(ranked: Floats, count: int) -> list[Poses]:
    kept: list[Poses] = []
    for row in ranked:
        pose = row[:3].copy()
        if all(not same_place(pose, other) for other in kept):
            pose[2] = wrap(pose[2])
            kept.append(pose)
            if len(kept) == count:
                break
    return kept


def same_place(a: Poses, b: Poses) -> bool:
    """Whether two poses are too near to each other to be different answers."""
    return bool(
        np.hypot(a[0] - b[0], a[1] - b[1]) < _APART_M and abs(wrap(a[2] - b[2])) < _APART_RAD
    )


@compiled
def score_places(
    fit: Grid,
    origin: Floats,
    cell_m: float,
    points: Floats,
    headings: Floats,
    xs: Floats,
    ys: Floats,
    scores: Grid,
) -> None:
    """Sum of how well all points fit, for each heading, y and x."""
    height, width = fit.shape
    for heading in range(headings.shape[0]):
        c, s = np.cos(headings[heading]), np.sin(headings[heading])
        for index in range(points.shape[0]):
            px = c * points[index, 0] - s * points[index, 1] - origin[0]
            py = s * points[index, 0] + c * points[index, 1] - origin[1]
            for y in range(ys.shape[0]):
                row = int(np.floor((ys[y] + py) / cell_m + 0.5))
                if row < 0 or row >= height:
                    continue
                for x in range(xs.shape[0]):
                    column = int(np.floor((xs[x] + px) / cell_m + 0.5))
                    if 0 <= column < width:
                        scores[heading, y, x] += fit[row, column]


@compiled
def refine(
    fit: Grid,
    origin: Floats,
    cell_m: float,
    points: Floats,
    pose: Floats,
    step_m: float,
    step_rad: float,
) -> float:
    """Climb from a pose, in place, as long as a step to any side fits better; the score there."""
    best = -1.0
    for _ in range(8):
        bx, by, bt = pose[0], pose[1], pose[2]
        moved = False
        for turn in range(-1, 2):
            angle = bt + turn * step_rad
            c, s = np.cos(angle), np.sin(angle)
            for right in range(-1, 2):
                for up in range(-1, 2):
                    x, y = bx + right * step_m, by + up * step_m
                    total = 0.0
                    for index in range(points.shape[0]):
                        px = x + c * points[index, 0] - s * points[index, 1] - origin[0]
                        py = y + s * points[index, 0] + c * points[index, 1] - origin[1]
                        column = int(np.floor(px / cell_m + 0.5))
                        row = int(np.floor(py / cell_m + 0.5))
                        if 0 <= row < fit.shape[0] and 0 <= column < fit.shape[1]:
                            total += fit[row, column]
                    if total > best + 1e-9:
                        best = total
                        pose[0], pose[1], pose[2] = x, y, angle
                        moved = turn != 0 or right != 0 or up != 0
        if not moved:
            break
    return best
