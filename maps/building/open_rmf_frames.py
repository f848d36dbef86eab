"""From the drawings of an Open-RMF plan to metres in one frame."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.errors import WrongInputError
from mend.maps.building.open_rmf_plan import Level, Plan, property_of

Matrix = NDArray[np.float64]

EARTH_M = 6_378_137.0
"""The equator's radius (WGS 84)."""


@dataclass(frozen=True, slots=True)
class Similarity:
    """Turns, scales and shifts points (n, 2)."""

    linear: Matrix
    shift: Matrix

    def __call__(self, points: Matrix) -> Matrix:
        return np.asarray(points @ self.linear.T + self.shift)


def frames_of(plan: Plan) -> dict[str, Similarity]:
    """How each level's vertices become metres in the frame of the reference level."""
    if plan.coordinate_system == "wgs84":
        return dict.fromkeys(plan.levels, _from_globe(plan))
    if plan.coordinate_system == "cartesian_meters":
        return dict.fromkeys(plan.levels, Similarity(np.eye(2), np.zeros(2)))
    reference = plan.reference_level_name or next(iter(plan.levels))
    if reference not in plan.levels:
        raise WrongInputError(f"the plan has no level '{reference}', which it names as reference")
    own = {name: _in_metres(name, each, plan) for name, each in plan.levels.items()}
    to = _fiducials(plan.levels[reference], own[reference])
    return {
        name: _laid_over(own[name], _fiducials(each, own[name]), to)
        for name, each in plan.levels.items()
    }


def _in_metres(name: str, level: Level, plan: Plan) -> Similarity:
    """By its own measurements, or where it has none by those of all other levels."""
    scales = _scales(level) or [each for other in plan.levels.values() for each in _scales(other)]
    if not scales:
        raise WrongInputError(
            f"nothing on level '{name}' is measured: how long a pixel is, is unknown"
        )
    scale = float(np.mean(scales))
    return Similarity(np.diag([scale, -scale]), np.zeros(2))


def _scales(level: Level) -> list[float]:
    """Metres per pixel, by each measured edge."""
    found = []
    for each in level.measurements:
        a, b = (level.vertices[end] for end in each[:2])
        pixels, metres = math.hypot(a[0] - b[0], a[1] - b[1]), property_of(each, "distance")
        if pixels > 0.0 and isinstance(metres, int | float) and metres > 0.0:
            found.append(metres / pixels)
    return found


def _fiducials(level: Level, frame: Similarity) -> dict[str, Matrix]:
    return {name: frame(np.array([[x, y]]))[0] for x, y, name in level.fiducials}


def _laid_over(own: Similarity, of: Mapping[str, Matrix], to: Mapping[str, Matrix]) -> Similarity:
    """Turned and shifted so that fiducials of one name lie best above each other.

    Umeyama, "Least-squares estimation of transformation parameters between two point patterns",
    IEEE PAMI 13 (1991), equations 40 to 42, without a scale.
    """
    both = [name for name in of if name in to]
    if len(both) < 2:
        return own
    a, b = (np.array([each[name] for name in both]) for each in (of, to))
    u, _, v = np.linalg.svd((b - b.mean(0)).T @ (a - a.mean(0)))
    turn = u @ np.diag([1.0, np.linalg.det(u @ v)]) @ v
    shift = b.mean(0) - turn @ a.mean(0)
    return Similarity(turn @ own.linear, turn @ own.shift + shift)


def _from_globe(plan: Plan) -> Similarity:
    """A plane that touches the globe in the middle of the plan."""
    points = np.array([each[:2] for level in plan.levels.values() for each in level.vertices])
    middle = points.mean(axis=0) if len(points) else np.zeros(2)
    north_m = math.radians(1.0) * EARTH_M
    linear = np.diag([north_m * math.cos(math.radians(middle[1])), north_m])
    return Similarity(linear, -linear @ middle)
