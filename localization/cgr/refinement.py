"""The kernel of corrective gradient refinement: particles pulled to the lines that they see."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.cgr.parameters import CgrParameters
from mend.localization.points import ScanPoints
from mend.localization.pose import Poses
from mend.maps.compiled import compiled
from mend.maps.ray_cast import NOTHING
from mend.maps.segment_grid import SegmentGrid, cast_ray, segment_grid

Matrix = NDArray[np.float64]
Indices = NDArray[np.int64]


class Refinement:
    """Moves particles to where the lines that they see explain a scan best, and weighs them."""

    def __init__(self, segments: Matrix, parameters: CgrParameters) -> None:
        its = parameters
        self._grid = segment_grid(segments)
        self._lines = lines_of(segments)
        self._gates = np.array(
            [its.attracted_within_m, np.cos(its.attracted_within_rad), its.margin_m]
        )
        self._rates = np.array([its.place_share, its.turn_share, its.step_m, its.step_rad])
        self._steps = its.refinements
        self._least = its.least_explained
        self._surprise = 0.5 * (its.surprise_m / its.deviation_m) ** 2
        self._deviation = its.deviation_m
        self._trust = its.trust

    def __call__(
        self, particles: Poses, points: ScanPoints, sensor: Poses, reach_m: float
    ) -> tuple[Poses, Matrix, Matrix]:
        """Refined particles, and log-likelihoods before and after."""
        refined = particles.copy()
        before, after = np.empty(len(particles)), np.empty(len(particles))
        refine(
            self._grid,
            self._lines,
            points.points,
            points.normals,
            sensor[:2],
            reach_m,
            self._gates,
            self._rates,
            self._steps,
            self._least,
            self._deviation,
            self._surprise,
            refined,
            before,
            after,
        )
        return refined, self._trust * before, self._trust * after

    def distances(self, pose: Poses, points: ScanPoints, sensor: Poses, reach_m: float) -> Matrix:
        """Metres from each point to the line that it was seen on; infinite where there is none."""
        seen = np.empty(len(points), dtype=np.int64)
        look(self._grid, pose, points.points, sensor[:2], reach_m, seen)
        away = np.empty(len(points))
        measure(self._lines, pose, points.points, seen, self._gates[2], away)
        return away


def lines_of(segments: Matrix) -> Matrix:
    """Rows x0, y0, direction x and y, length: what a point is measured against."""
    ends = segments[:, 2:] - segments[:, :2]
    lengths = np.hypot(ends[:, 0], ends[:, 1])
    return np.column_stack((segments[:, :2], ends / np.maximum(lengths, 1e-9)[:, None], lengths))


@compiled
def refine(
    grid: SegmentGrid,
    lines: Matrix,
    points: Matrix,
    normals: Matrix,
    sensor: Matrix,
    reach_m: float,
    gates: Matrix,
    rates: Matrix,
    steps: int,
    least: float,
    deviation: float,
    surprise: float,
    particles: Poses,
    before: Matrix,
    after: Matrix,
) -> None:
    """Refine each particle in place; a ray cast each, kept through the steps."""
    seen = np.empty(points.shape[0], dtype=np.int64)
    away = np.empty(points.shape[0])
    for number in range(particles.shape[0]):
        pose = particles[number]
        look(grid, pose, points, sensor, reach_m, seen)
        measure(lines, pose, points, seen, gates[2], away)
        before[number] = _log_likelihood(away, deviation, surprise)
        for _ in range(steps):
            if not _step(lines, points, normals, seen, gates, rates, least, pose):
                break
        measure(lines, pose, points, seen, gates[2], away)
        after[number] = _log_likelihood(away, deviation, surprise)


@compiled
def look(
    grid: SegmentGrid,
    pose: Poses,
    points: Matrix,
    sensor: Matrix,
    reach_m: float,
    seen: Indices,
) -> None:
    """Which segment is seen in the direction of each point, from the sensor at a pose."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    x = pose[0] + cosine * sensor[0] - sine * sensor[1]
    y = pose[1] + sine * sensor[0] + cosine * sensor[1]
    for index in range(points.shape[0]):
        dx, dy = points[index, 0] - sensor[0], points[index, 1] - sensor[1]
        away = max(np.hypot(dx, dy), 1e-9)
        c, s = (cosine * dx - sine * dy) / away, (sine * dx + cosine * dy) / away
        seen[index] = cast_ray(grid, x, y, c, s, reach_m)[1]


@compiled
def measure(
    lines: Matrix, pose: Poses, points: Matrix, seen: Indices, margin: float, away: Matrix
) -> None:
    """Metres from each point to its line; infinite where it has none or lies beyond its ends."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    for index in range(points.shape[0]):
        away[index] = np.inf
        line = seen[index]
        if line == NOTHING:
            continue
        dx = pose[0] + cosine * points[index, 0] - sine * points[index, 1] - lines[line, 0]
        dy = pose[1] + sine * points[index, 0] + cosine * points[index, 1] - lines[line, 1]
        along = dx * lines[line, 2] + dy * lines[line, 3]
        if -margin <= along <= lines[line, 4] + margin:
            away[index] = abs(dy * lines[line, 2] - dx * lines[line, 3])


@compiled
def _log_likelihood(away: Matrix, deviation: float, surprise: float) -> float:
    total = 0.0
    for index in range(away.shape[0]):
        total += min(0.5 * (away[index] / deviation) ** 2, surprise)
    return -total


@compiled
def _step(
    lines: Matrix,
    points: Matrix,
    normals: Matrix,
    seen: Indices,
    gates: Matrix,
    rates: Matrix,
    least: float,
    pose: Poses,
) -> bool:
    """One step along the mean pull of the lines; False where too few points feel one."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    pulled = 0
    pull_x, pull_y, turn = 0.0, 0.0, 0.0
    for index in range(points.shape[0]):
        line = seen[index]
        if line == NOTHING:
            continue
        rx = cosine * points[index, 0] - sine * points[index, 1]
        ry = sine * points[index, 0] + cosine * points[index, 1]
        dx, dy = pose[0] + rx - lines[line, 0], pose[1] + ry - lines[line, 1]
        ux, uy = lines[line, 2], lines[line, 3]
        along = dx * ux + dy * uy
        off = dy * ux - dx * uy
        if abs(off) > gates[0] or not -gates[2] <= along <= lines[line, 4] + gates[2]:
            continue
        nx = cosine * normals[index, 0] - sine * normals[index, 1]
        ny = sine * normals[index, 0] + cosine * normals[index, 1]
        if abs(ny * ux - nx * uy) < gates[1]:
            continue
        px, py = uy * off, -ux * off
        pulled += 1
        pull_x += px
        pull_y += py
        turn += np.arctan2(rx * (ry + py) - ry * (rx + px), rx * (rx + px) + ry * (ry + py))
    if pulled < 3 or pulled < least * points.shape[0]:
        return False
    pull_x *= rates[0] / pulled
    pull_y *= rates[0] / pulled
    length = np.hypot(pull_x, pull_y)
    if length > rates[2]:
        pull_x *= rates[2] / length
        pull_y *= rates[2] / length
    pose[0] += pull_x
    pose[1] += pull_y
    pose[2] += min(max(turn * rates[1] / pulled, -rates[3]), rates[3])
    return True
