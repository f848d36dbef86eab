"""Fitting level rectangles to pixels, finer than the pixel grid.

Each pixel is covered by the rectangle to a share that falls from 1 to 0 across its rim; centre,
direction and (where not known) extents are those whose coverage is nearest, in least squares, to
what was seen (Levenberg-Marquardt). Pixels behind something nearer say nothing.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.affinity import rotate, translate

from mend.maps.compiled import compiled
from mend.robots.vision.evidence import Evidence
from mend.robots.vision.level_rectangle import Rectangle

Array = NDArray[np.float64]
Ends = NDArray[np.int64]
Extents = tuple[float, float]

_COARSE_TO_FINE = (3.0, 1.5, 1.0)
"""Widths of the rim in pixels: a wide one first draws the rectangle near."""
_ITERATIONS = 8
_STEP_M = 1e-4
"""So far the parameters are moved to see what changes; an angle, so that the ends move so far."""
_BESIDE_RIM_M = 5 * _STEP_M
_SEEN_SIDE = 0.5
"""A side is seen if just outside more than this share of it nothing hides the view."""


@dataclass(frozen=True, slots=True)
class Fitted:
    """A rectangle, how much of it is seen and which of its sides (-x, +x, -y, +y) are.

    `misfit` is the mean squared difference of coverage around the rim, `shown` the share of its
    area that is seen.
    """

    rectangle: Rectangle
    sides_seen: tuple[bool, bool, bool, bool]
    misfit: float
    shown: float

    def turned(self) -> "Fitted":
        """The same rectangle with its x axis along what was its y axis."""
        old = self.rectangle
        length, width = old.extents
        return replace(
            self,
            rectangle=Rectangle(old.x, old.y, old.yaw + math.pi / 2, (width, length)),
            sides_seen=(*self.sides_seen[2:], self.sides_seen[1], self.sides_seen[0]),
        )

    def outline(self, hidden_m: float = 0.0) -> shapely.Polygon:
        """From above, and as far beyond each side that is not seen."""
        at, more = self.rectangle, [0.0 if seen else hidden_m for seen in self.sides_seen]
        length, width = at.extents
        xs = (-length / 2 - more[0], length / 2 + more[1])
        ys = (-width / 2 - more[2], width / 2 + more[3])
        turned = rotate(shapely.box(xs[0], ys[0], xs[1], ys[1]), at.yaw, (0, 0), use_radians=True)
        return translate(turned, at.x, at.y)

    @property
    def whole(self) -> tuple[bool, bool]:
        """Along which of its axes both ends are seen."""
        return self.sides_seen[0] and self.sides_seen[1], self.sides_seen[2] and self.sides_seen[3]


def fit_any(evidence: Evidence) -> Fitted:
    """The rectangle of whatever size that fits best."""
    points = evidence.points[evidence.inside > 0]
    # Millimetres keep the single precision of OpenCV's rectangle harmless.
    (x, y), (length, width), angle = cv2.minAreaRect((points * 1e3).astype(np.float32))
    start = Rectangle(
        x / 1e3 - evidence.rim[0] / 2,
        y / 1e3 - evidence.rim[1] / 2,
        math.radians(angle),
        (max(length / 1e3, evidence.pixel_m), max(width / 1e3, evidence.pixel_m)),
    )
    return _cut_to_seen(evidence, _fitted(evidence, *_fit([evidence], start)))


def fit_sized(evidence: Evidence, starts: Sequence[Rectangle]) -> Fitted:
    """The rectangle of the size of `starts` that fits best near one of them."""
    fits = [_fit([evidence], start, [start.extents]) for start in starts]
    return _fitted(evidence, *min(fits, key=lambda each: each[1]))


def fit_with_knob(
    plate: Evidence, knob: Evidence, starts: Sequence[Rectangle], extents: Extents
) -> Fitted:
    """The plate of the size of `starts` that fits best near one, with a knob on its middle.

    `extents` of the knob along the plate's axes: one pose explains both surfaces. What is `shown`
    of the knob counts as the plate that is under it.
    """
    fits = [_fit([plate, knob], start, [start.extents, extents]) for start in starts]
    found = _fitted(plate, *min(fits, key=lambda each: each[1]))
    on_top = replace(found.rectangle, extents=extents)
    sides = zip(found.sides_seen, _sides_seen(knob, on_top), strict=True)
    left, right, near, far = (one or other for one, other in sides)
    share = math.prod(extents) / math.prod(found.rectangle.extents)
    return replace(
        found,
        sides_seen=(left, right, near, far),
        shown=found.shown + share * _shown(knob, on_top),
    )


def _fit(
    evidence: Sequence[Evidence], start: Rectangle, sizes: Sequence[Extents] | None = None
) -> tuple[Rectangle, float]:
    """Rectangles with one centre and direction, of given sizes; of free size where none is.

    The first of them, and their misfit.
    """
    found, misfit = _descend(
        np.concatenate([each.points[each.telling] for each in evidence]),
        np.concatenate([each.inside[each.telling] for each in evidence]),
        np.cumsum([0, *(np.count_nonzero(each.telling) for each in evidence)]),
        np.array([each.rim for each in evidence]),
        np.array([start.x, start.y, start.yaw, *np.ravel(sizes or [start.extents])]),
        5 if sizes is None else 3,
        np.array(_COARSE_TO_FINE) * evidence[0].pixel_m,
    )
    x, y, yaw, length, width = (float(each) for each in found[:5])
    return Rectangle(x, y, yaw, (length, width)), float(misfit)


def _fitted(evidence: Evidence, found: Rectangle, misfit: float) -> Fitted:
    return Fitted(found, _sides_seen(evidence, found), misfit, _shown(evidence, found))


def _cut_to_seen(evidence: Evidence, found: Fitted) -> Fitted:
    """Ends that are hidden could be anywhere behind what hides them: only what is seen counts.

    So does only what has a depth: without, a side of the same colour could not be told from it.
    """
    inside = evidence.inside > 0
    measured = inside & evidence.measured
    if all(found.sides_seen):
        return found
    old = found.rectangle
    local = old.local(evidence.points[measured if measured.any() else inside])
    ends = []
    for axis in range(2):
        half, margin = old.extents[axis] / 2, evidence.pixel_m / 2
        low_seen, high_seen = found.sides_seen[2 * axis : 2 * axis + 2]
        low = -half if low_seen else max(-half, local[:, axis].min() - margin)
        high = half if high_seen else min(half, local[:, axis].max() + margin)
        ends.append((float(low), float(high)))
    (left, right), (near, far) = ends
    dx, dy = (left + right) / 2, (near + far) / 2
    x, y = old.point(dx, dy)
    return replace(found, rectangle=Rectangle(x, y, old.yaw, (right - left, far - near)))


def _sides_seen(evidence: Evidence, found: Rectangle) -> tuple[bool, bool, bool, bool]:
    """Whether it can be told that the surface ends at each side."""
    local = found.local(evidence.points)
    rim = found.local(evidence.rim[None] + (found.x, found.y))[0]
    half_x, half_y = found.extents[0] / 2, found.extents[1] / 2
    reach = 2.0 * evidence.pixel_m
    answers = []
    for axis, half, other in ((0, half_x, half_y), (1, half_y, half_x)):
        along = np.abs(local[:, 1 - axis]) <= max(other - 0.5 * evidence.pixel_m, 1e-4)
        for sign in (-1.0, 1.0):
            drawn_out = max(sign * rim[axis], 0.0)
            beyond = sign * local[:, axis] - half - drawn_out
            strip = along & (beyond > 0.3 * evidence.pixel_m) & (beyond <= reach)
            told = evidence.telling[strip] * (1.0 - evidence.inside[strip])
            answers.append(bool(len(told) > 0 and told.mean() > _SEEN_SIDE))
    return answers[0], answers[1], answers[2], answers[3]


def _shown(evidence: Evidence, found: Rectangle) -> float:
    within = found.holds(evidence.points, 0.0)
    seen_m2 = float(evidence.inside[within].sum()) * evidence.pixel_m2
    return min(seen_m2 / (found.extents[0] * found.extents[1]), 1.0)


@compiled
def _residuals(
    points: Array,
    inside: Array,
    ends: Ends,
    rims: Array,
    given: Array,
    rim_m: float,
    out: Array,
    outside: Array,
) -> float:
    """Coverage less what was seen, per pixel, of the rectangles swept along their rims.

    `outside` gets how far outside of its rectangle each pixel is.
    """
    total = 0.0
    for k in range(rims.shape[0]):
        one = slice(ends[k], ends[k + 1])
        box = given[3 + 2 * k : 5 + 2 * k]
        _measure_outside(points[one], rims[k], given, box, outside[one])
    for i in range(points.shape[0]):
        cover = min(max(0.5 - outside[i] / rim_m, 0.0), 1.0)
        out[i] = cover - inside[i]
        total += out[i] * out[i]
    return total


@compiled
def _measure_outside(points: Array, rim: Array, pose: Array, extents: Array, out: Array) -> None:
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    half_x, half_y = extents[0] / 2, extents[1] / 2
    rx, ry = cos * rim[0] + sin * rim[1], cos * rim[1] - sin * rim[0]
    length = math.sqrt(rx * rx + ry * ry)
    ax, ay = (rx / length, ry / length) if length > 1e-9 else (1.0, 0.0)
    across_most = half_x * abs(ay) + half_y * abs(ax)
    low_x, high_x = -half_x + min(rx, 0.0), half_x + max(rx, 0.0)
    low_y, high_y = -half_y + min(ry, 0.0), half_y + max(ry, 0.0)
    for i in range(points.shape[0]):
        dx, dy = points[i, 0] - pose[0], points[i, 1] - pose[1]
        x, y = cos * dx + sin * dy, cos * dy - sin * dx
        out[i] = max(max(low_x - x, x - high_x), max(low_y - y, y - high_y))
        if length > 1e-9:
            out[i] = max(out[i], abs(x * ay - y * ax) - across_most)


@compiled
def _jacobian(
    points: Array,
    inside: Array,
    ends: Ends,
    rims: Array,
    given: Array,
    free: int,
    rim_m: float,
    base: Array,
    outside: Array,
) -> tuple[Array, Array]:
    """How the residuals change with the first `free` parameters, and what they are.

    Of the pixels at the rim: of all others, coverage stays 0 or 1.
    """
    at_rim = np.abs(outside) < rim_m / 2 + _BESIDE_RIM_M
    near, near_inside = points[at_rim], inside[at_rim]
    near_ends = np.zeros_like(ends)
    for k in range(rims.shape[0]):
        near_ends[k + 1] = near_ends[k] + np.sum(at_rim[ends[k] : ends[k + 1]])
    jacobian = np.zeros((free, near.shape[0]))
    trial, unused = given.copy(), np.zeros(near.shape[0])
    rest = base[at_rim]
    for k in range(free):
        step = _STEP_M if k != 2 else _STEP_M / max(given[3], given[4], 0.01)
        trial[:] = given
        trial[k] += step
        _residuals(near, near_inside, near_ends, rims, trial, rim_m, jacobian[k], unused)
        jacobian[k] = (jacobian[k] - rest) / step
    return jacobian, rest


@compiled
def _descend(
    points: Array, inside: Array, ends: Ends, rims: Array, given: Array, free: int, rims_m: Array
) -> tuple[Array, float]:
    """Levenberg-Marquardt over the first `free` parameters; the best, and its misfit."""
    n = points.shape[0]
    best, trial = given.copy(), given.copy()
    base, moved = np.zeros(n), np.zeros(n)
    outside, moved_outside = np.zeros(n), np.zeros(n)
    cost = 0.0
    for stage in range(rims_m.shape[0]):
        rim_m = rims_m[stage]
        damping = 1e-3
        cost = _residuals(points, inside, ends, rims, best, rim_m, base, outside)
        for _ in range(_ITERATIONS):
            jacobian, rest = _jacobian(points, inside, ends, rims, best, free, rim_m, base, outside)
            normal = jacobian @ jacobian.T
            slope = jacobian @ rest
            improved = False
            for _ in range(4):
                damped = normal.copy()
                for k in range(free):
                    damped[k, k] += damping * normal[k, k] + 1e-9
                change = np.linalg.solve(damped, slope)
                trial[:] = best
                for k in range(free):
                    limit = 2.0 * rim_m if k != 2 else 0.3
                    trial[k] -= min(max(change[k], -limit), limit)
                trial[3], trial[4] = max(trial[3], 1e-3), max(trial[4], 1e-3)
                new = _residuals(points, inside, ends, rims, trial, rim_m, moved, moved_outside)
                if new < cost:
                    gain = cost - new
                    best[:], base[:], outside[:] = trial, moved, moved_outside
                    cost = new
                    damping = max(damping * 0.3, 1e-6)
                    improved = gain > 1e-6 * (1.0 + cost)
                    break
                damping *= 5.0
            if not improved:
                break
    around = 2.0 * best[3:].sum() / rims_m[rims_m.shape[0] - 1]
    return best, cost / max(around, 1.0)
