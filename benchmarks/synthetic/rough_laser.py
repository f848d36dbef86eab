"""A second laser: what cheap ones, glass and floors that are not level do to a scan.

Its errors are of other kinds than those of the plain laser, with which everything was set: they
grow with the range and have heavy tails (Student's t, 3 degrees of freedom), beams that hit an edge
come back from between the two surfaces (mixed pixels; Tuley et al. 2005), glass is seen from about
straight ahead only, and where robot or floor tilt, beams end at the floor.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import Poses
from mend.maps.ray_cast import NOTHING, cast

Matrix = NDArray[np.float64]
Mask = NDArray[np.bool_]

_DEGREES_OF_FREEDOM = 3.0
_NEAREST_M = 0.05


@dataclass(frozen=True, slots=True)
class RoughLaser:
    """The dials of the second laser. Errors of ranges are `noise_m` and `noise_per_m` a metre."""

    noise_m: float = 0.01
    noise_per_m: float = 0.01
    step_m: float = 0.01
    """Ranges are told in such steps."""
    missing: float = 0.02
    """The share of beams that never come back, as of what is black."""
    edge_m: float = 0.3
    """Neighbouring beams that differ by more are at an edge."""
    mixed: float = 0.5
    """So many of the beams at an edge come back from in between."""
    glass: float = 0.1
    """The share of the walls that is glass."""
    glass_within_rad: float = np.radians(20.0)
    """Glass is seen where a beam meets it within so much of its normal; else what is behind it."""
    tilt_rad: float = np.radians(1.2)
    """Standard deviation of the tilt ahead, and sideways."""
    tilt_over_m: float = 2.0
    """Over so much of the way the tilt changes."""
    height_m: float = 0.25
    """How high the laser is."""


@dataclass(frozen=True, slots=True, eq=False)
class RoughDrive:
    """One drive's glass (which walls), and its tilts (n, 2) ahead and to the left, in radians."""

    laser: RoughLaser
    glass: Mask
    tilts: Matrix

    @classmethod
    def of(
        cls, laser: RoughLaser, walls: int, way: Poses, generator: np.random.Generator
    ) -> "RoughDrive":
        """Which of so many walls are glass, and how floor and robot tilt along a way."""
        glass = generator.random(walls) < laser.glass
        steps_m = np.hypot(*np.diff(way[:, :2], axis=0, prepend=way[:1, :2]).T)
        tilts, now = np.empty((len(way), 2)), generator.normal(0.0, laser.tilt_rad, 2)
        for index, step_m in enumerate(steps_m):
            kept = np.exp(-step_m / laser.tilt_over_m)
            fresh = generator.normal(0.0, laser.tilt_rad * np.sqrt(1.0 - kept**2), 2)
            now = kept * now + fresh
            tilts[index] = now
        return cls(laser, glass, tilts)

    def ranges(
        self,
        index: int,
        around: Matrix,
        pose: Poses,
        angles: Matrix,
        max_range_m: float,
        generator: np.random.Generator,
    ) -> Matrix:
        """What is measured at a step; `around` are the walls (n, 4), and what else stands there."""
        laser, headings = self.laser, pose[2] + angles
        true_m, hit = cast(around, float(pose[0]), float(pose[1]), headings, max_range_m)
        true_m, hit = self._through_glass(around, pose, headings, true_m, hit, max_range_m)
        seen = hit != NOTHING
        down = self.tilts[index, 0] * np.cos(angles) + self.tilts[index, 1] * np.sin(angles)
        floor_m = np.where(down > 1e-6, laser.height_m / np.maximum(down, 1e-6), np.inf)
        ends_at_floor = floor_m < np.where(seen, true_m, max_range_m)
        true_m, seen = np.where(ends_at_floor, floor_m, true_m), seen | ends_at_floor
        mixed_m = _mixed(true_m, seen, laser, generator)
        tail = generator.standard_t(_DEGREES_OF_FREEDOM, len(angles))
        noisy_m = mixed_m + tail * (laser.noise_m + laser.noise_per_m * mixed_m)
        told_m = np.maximum(np.round(noisy_m / laser.step_m) * laser.step_m, _NEAREST_M)
        seen &= (generator.random(len(angles)) >= laser.missing) & (told_m <= max_range_m)
        return np.where(seen, told_m, np.inf)

    def _through_glass(
        self,
        around: Matrix,
        pose: Poses,
        headings: Matrix,
        true_m: Matrix,
        hit: NDArray[np.int64],
        max_range_m: float,
    ) -> tuple[Matrix, NDArray[np.int64]]:
        """Beams that meet glass aslant end at what is behind all of it."""
        walls = around[: len(self.glass)]
        meets = (hit != NOTHING) & (hit < len(self.glass))
        meets[meets] = self.glass[hit[meets]]
        along = walls[hit[meets], 2:] - walls[hit[meets], :2]
        off = headings[meets] - np.arctan2(along[:, 1], along[:, 0]) - np.pi / 2.0
        aslant = np.abs(np.mod(off + np.pi / 2.0, np.pi) - np.pi / 2.0)
        passes = np.flatnonzero(meets)[aslant > self.laser.glass_within_rad]
        if not len(passes):
            return true_m, hit
        opaque = np.ascontiguousarray(np.vstack([walls[~self.glass], around[len(self.glass) :]]))
        behind_m, behind = cast(
            opaque, float(pose[0]), float(pose[1]), headings[passes], max_range_m
        )
        true_m, hit = true_m.copy(), hit.copy()
        true_m[passes] = behind_m
        hit[passes] = np.where(behind == NOTHING, NOTHING, len(around))
        return true_m, hit


def _mixed(true_m: Matrix, seen: Mask, laser: RoughLaser, generator: np.random.Generator) -> Matrix:
    """Ranges of which some beside an edge come back from between its two surfaces."""
    other_m = np.roll(true_m, 1)
    at_edge = seen & np.roll(seen, 1) & (np.abs(other_m - true_m) > laser.edge_m)
    at_edge[0] = False
    at_edge &= generator.random(len(true_m)) < laser.mixed
    share = generator.random(len(true_m))
    return np.where(at_edge, share * true_m + (1.0 - share) * other_m, true_m)
