"""Fitting level rectangles to pixels, finer than the pixel grid.

Each pixel is covered by the rectangle to a share that falls from 1 to 0 across its rim; centre,
direction and (where not known) extents are those whose coverage is nearest, in least squares, to
what was seen (Levenberg-Marquardt). Pixels behind something nearer say nothing.
"""

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.affinity import rotate, translate

from maps.compiled import compiled
from robots.body import CameraImage
from robots.vision.level_rectangle import Rectangle
from robots.vision.level_surfaces import Surface, Surfaces
from robots.vision.projection import pixel_area_m2

Array = NDArray[np.float64]

_AROUND_PX = 5
_DEEP = np.ones((25, 25), np.uint8)
_COARSE_TO_FINE = (3.0, 1.5, 1.0)
"""Widths of the rim in pixels: a wide one first draws the rectangle near."""
_ITERATIONS = 8
_SPLINTER = 0.3
"""What is as high as a surface and smaller than this share of it may be a splinter of its rim."""
_SAME_HUE = 0.25
"""A surface in another shade has all channels changed by the same factor, so far."""
_SEEN_SIDE = 0.5
"""A side is seen if just outside more than this share of it nothing hides the view."""


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """What the pixels around a surface say, on the plane at its height.

    `points` (n, 2); `inside` 1 where the pixel shows the surface; `weight` 0 where it says
    nothing; `measured` where it has a depth, so that more than its colour says where it is.
    `rim` (2,): sides that face the camera draw the surface out by this much, as far as they are
    within its height's tolerance. `pixel_m` is what a pixel spans across there, `pixel_m2` the area
    that it covers.
    """

    points: NDArray[np.float64]
    inside: NDArray[np.float64]
    weight: NDArray[np.float64]
    measured: NDArray[np.bool_]
    rim: NDArray[np.float64]
    pixel_m: float
    pixel_m2: float


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


def gather(
    surface: Surface, surfaces: Surfaces, pixels: NDArray[np.bool_] | None = None
) -> Evidence:
    """The evidence for one surface, or for those of its `pixels` that are chosen."""
    seen = surfaces.heights
    image = seen.image
    left, top = surface.us.min() - _AROUND_PX, surface.vs.min() - _AROUND_PX
    right, bottom = surface.us.max() + _AROUND_PX, surface.vs.max() + _AROUND_PX
    patch = np.s_[max(top, 0) : bottom + 1, max(left, 0) : right + 1]
    height, labels = seen.height_m[patch], surfaces.labels[patch]
    inside = labels == surface.label
    if pixels is not None:
        chosen = np.zeros(labels.shape, np.bool_)
        chosen[surface.vs[pixels] - max(top, 0), surface.us[pixels] - max(left, 0)] = True
        inside = chosen
    with np.errstate(invalid="ignore"):
        low = height < surface.top_z - surfaces.tolerance_m
    near = set(np.unique(labels).tolist())
    splinters = [
        each.label
        for each in surfaces.all
        if each.label in near and _is_splinter(each, surface, surfaces)
    ]
    other = (labels > 0) & ~inside & ~np.isin(labels, splinters)
    # Without depth only the table's own colour says that nothing is in front.
    off = np.abs(image.bgr[patch].astype(np.float64) - surfaces.table_color).max(axis=2)
    distinct = np.abs(surface.color - surfaces.table_color).max() > 2 * surfaces.alike
    table = np.isnan(height) & (off < surfaces.alike) & distinct & ~inside
    with np.errstate(invalid="ignore"):
        in_front = height > surface.top_z + surfaces.tolerance_m
    weight = (inside | low | other | table) & ~in_front
    # Deep inside nothing changes, however the rectangle is moved to fit.
    weight &= np.asarray(cv2.erode(inside.astype(np.uint8), _DEEP)) == 0
    vs, us = np.mgrid[
        patch[0].start : patch[0].start + height.shape[0],
        patch[1].start : patch[1].start + height.shape[1],
    ]
    points = _on_plane(image, us.ravel(), vs.ravel(), surface.top_z)
    middle = points[inside.ravel()].mean(axis=0)
    to_eye = image.pose[:3, 3] - np.append(middle, surface.top_z)
    pixel_m = float(np.linalg.norm(to_eye)) / image.focal_px
    tolerance = min(surfaces.tolerance_m, surface.top_z - seen.table_z)
    return Evidence(
        points,
        inside.ravel().astype(np.float64),
        weight.ravel().astype(np.float64),
        ~np.isnan(height).ravel(),
        to_eye[:2] * (tolerance / to_eye[2]),
        pixel_m,
        pixel_area_m2(image, (float(middle[0]), float(middle[1]), surface.top_z)),
    )


def _is_splinter(other: Surface, surface: Surface, surfaces: Surfaces) -> bool:
    """Whether what is as high as a surface may be a piece of its rim, or of its side just below.

    Such a piece is small, or smaller and of the same hue in another shade.
    """
    if other is surface or abs(other.top_z - surface.top_z) > surfaces.tolerance_m:
        return False
    shades = (other.color + 1.0) / (surface.color + 1.0)
    same_hue = np.ptp(shades) < _SAME_HUE * shades.mean()
    return bool(other.core_px < (1.0 if same_hue else _SPLINTER) * surface.core_px)


def _on_plane(
    image: CameraImage, us: NDArray[np.intp], vs: NDArray[np.intp], z: float
) -> NDArray[np.float64]:
    """Where pixels' rays meet the level plane at `z`, (n, 2)."""
    across = (us - image.center_px[0]) / image.focal_px
    down = (vs - image.center_px[1]) / image.focal_px
    turn = image.pose[:3, :3]
    rays = [turn[axis, 0] * across + turn[axis, 1] * down + turn[axis, 2] for axis in range(3)]
    depth = (z - image.pose[2, 3]) / rays[2]
    return np.stack([image.pose[axis, 3] + rays[axis] * depth for axis in range(2)], axis=1)


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
    return _cut_to_seen(evidence, _fit(evidence, start, sized=False))


def fit_sized(evidence: Evidence, start: Rectangle) -> Fitted:
    """The rectangle of the size of `start` that fits best near there."""
    return _fit(evidence, start, sized=True)


def _fit(evidence: Evidence, start: Rectangle, *, sized: bool) -> Fitted:
    given = np.array([start.x, start.y, start.yaw, *start.extents])
    telling = evidence.weight > 0
    found, misfit = _descend(
        evidence.points[telling],
        evidence.inside[telling],
        evidence.weight[telling],
        evidence.rim,
        given,
        3 if sized else 5,
        np.array(_COARSE_TO_FINE) * evidence.pixel_m,
    )
    x, y, yaw, length, width = (float(each) for each in found)
    rectangle = Rectangle(x, y, yaw, (length, width))
    return Fitted(
        rectangle, _sides_seen(evidence, rectangle), float(misfit), _shown(evidence, rectangle)
    )


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
            told = evidence.weight[strip] * (1.0 - evidence.inside[strip])
            answers.append(bool(len(told) > 0 and told.mean() > _SEEN_SIDE))
    return answers[0], answers[1], answers[2], answers[3]


def _shown(evidence: Evidence, found: Rectangle) -> float:
    within = found.holds(evidence.points, 0.0)
    seen_m2 = float(evidence.inside[within].sum()) * evidence.pixel_m2
    return min(seen_m2 / (found.extents[0] * found.extents[1]), 1.0)


@compiled
def _residuals(
    points: Array, inside: Array, weight: Array, rim: Array, given: Array, rim_m: float, out: Array
) -> float:
    """Coverage less what was seen, per pixel, of the rectangle swept along the rim."""
    cos, sin = math.cos(given[2]), math.sin(given[2])
    half_x, half_y = given[3] / 2, given[4] / 2
    rx, ry = cos * rim[0] + sin * rim[1], cos * rim[1] - sin * rim[0]
    length = math.sqrt(rx * rx + ry * ry)
    ax, ay = (rx / length, ry / length) if length > 1e-9 else (1.0, 0.0)
    across_most = half_x * abs(ay) + half_y * abs(ax)
    low_x, high_x = -half_x + min(rx, 0.0), half_x + max(rx, 0.0)
    low_y, high_y = -half_y + min(ry, 0.0), half_y + max(ry, 0.0)
    total = 0.0
    for i in range(points.shape[0]):
        if weight[i] == 0.0:
            out[i] = 0.0
            continue
        dx, dy = points[i, 0] - given[0], points[i, 1] - given[1]
        x, y = cos * dx + sin * dy, cos * dy - sin * dx
        outside = max(max(low_x - x, x - high_x), max(low_y - y, y - high_y))
        if length > 1e-9:
            outside = max(outside, abs(x * ay - y * ax) - across_most)
        cover = min(max(0.5 - outside / rim_m, 0.0), 1.0)
        out[i] = cover - inside[i]
        total += out[i] * out[i]
    return total


@compiled
def _descend(
    points: Array, inside: Array, weight: Array, rim: Array, given: Array, free: int, rims_m: Array
) -> tuple[Array, float]:
    """Levenberg-Marquardt over the first `free` parameters; the best, and its misfit."""
    n = points.shape[0]
    best, trial = given.copy(), given.copy()
    base, moved = np.zeros(n), np.zeros(n)
    jacobian = np.zeros((free, n))
    cost = 0.0
    for stage in range(rims_m.shape[0]):
        rim_m = rims_m[stage]
        damping = 1e-3
        cost = _residuals(points, inside, weight, rim, best, rim_m, base)
        for _ in range(_ITERATIONS):
            for k in range(free):
                step = 1e-4 if k != 2 else 1e-4 / max(best[3], best[4], 0.01)
                trial[:] = best
                trial[k] += step
                _residuals(points, inside, weight, rim, trial, rim_m, moved)
                for i in range(n):
                    jacobian[k, i] = (moved[i] - base[i]) / step
            normal = jacobian @ jacobian.T
            slope = jacobian @ base
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
                new = _residuals(points, inside, weight, rim, trial, rim_m, moved)
                if new < cost:
                    gain = cost - new
                    best[:] = trial
                    base[:] = moved
                    cost = new
                    damping = max(damping * 0.3, 1e-6)
                    improved = gain > 1e-6 * (1.0 + cost)
                    break
                damping *= 5.0
            if not improved:
                break
    around = 2.0 * (best[3] + best[4]) / rims_m[rims_m.shape[0] - 1]
    return best, cost / max(around, 1.0)
