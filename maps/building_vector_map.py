"""Vector maps of laser points whose places are known: hits gathered in cells, cells in lines."""

from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mend.maps.clean_up import CleanUpSettings, clean_up
from mend.maps.vector_map import VectorMap

Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class BuildingSettings:
    """How walls are told from clutter."""

    cell_m: float = 0.05
    hits_dense: int = 4
    """Cells with fewer hits are dropped, where cells have many hits on average ..."""
    hits_sparse: int = 2
    """... and where they have few."""
    dense_from: float = 8.0
    """Average hits per cell from which on there are many."""
    coherence: float = 0.6
    """A line grows from cells whose normals agree at least so well (0: not at all, 1: fully)."""
    reach_m: float = 0.25
    """Cells this near each other may belong to one line."""
    angle_rad: float = radians(20.0)
    off_line_m: float = 0.06
    gap_m: float = 0.3
    """A line is cut where it has no cell for longer than this."""
    shortest_m: float = 0.3


@dataclass(frozen=True, slots=True)
class _Cells:
    places: Matrix
    angles: Matrix
    """Of the normals, without direction: modulo pi."""
    coherence: Matrix
    hits: Matrix


def build_vector_map(
    points: Matrix, normals: Matrix, name: str = "", settings: BuildingSettings | None = None
) -> VectorMap:
    """A map of points and unit normals (n, 2) in its frame; points without a normal are ignored."""
    its = settings or BuildingSettings()
    known = (normals != 0.0).any(axis=1) & np.isfinite(points).all(axis=1)
    if not known.any():
        return VectorMap(np.empty((0, 4)), name)
    cells = _gathered(points[known], normals[known], its)
    lines = _lines(cells, its)
    rows = np.array(lines).reshape(-1, 4)
    same = CleanUpSettings(apart_m=its.off_line_m, gap_m=0.1, shortest_m=its.shortest_m)
    return clean_up(VectorMap(rows, name), same)


def _gathered(points: Matrix, normals: Matrix, its: BuildingSettings) -> _Cells:
    """The mean hit and the mean normal of each cell that was hit often enough."""
    _, cell_of = np.unique(
        np.floor(points / its.cell_m).astype(np.int64), axis=0, return_inverse=True
    )
    cell_of = cell_of.ravel()
    hits = np.bincount(cell_of).astype(np.float64)

    def mean(values: Matrix) -> Matrix:
        sums: Matrix = np.bincount(cell_of, values) / hits
        return sums

    # Doubled, so that a normal and its opposite are the same.
    doubled = 2.0 * np.arctan2(normals[:, 1], normals[:, 0])
    cosine, sine = mean(np.cos(doubled)), mean(np.sin(doubled))
    places = np.column_stack((mean(points[:, 0]), mean(points[:, 1])))
    least = its.hits_dense if hits.mean() >= its.dense_from else its.hits_sparse
    often = hits >= least
    return _Cells(
        places[often],
        (np.arctan2(sine, cosine) / 2.0)[often],
        np.hypot(cosine, sine)[often],
        hits[often],
    )


def _lines(cells: _Cells, its: BuildingSettings) -> list[Matrix]:
    """Segments through cells, from those that are surest on."""
    if not len(cells.places):
        return []
    neighbours = cKDTree(cells.places).query_ball_point(cells.places, its.reach_m)
    left = np.ones(len(cells.places), dtype=bool)
    found: list[Matrix] = []
    for seed in np.argsort(-cells.hits * cells.coherence, kind="stable"):
        if not left[seed] or cells.coherence[seed] < its.coherence:
            continue
        members = _region(cells, neighbours, left, int(seed), its)
        if len(members) < 4:
            continue
        left[members] = False
        found.extend(_segments(cells.places[members], cells.hits[members], its))
    return found


def _region(
    cells: _Cells,
    neighbours: NDArray[np.object_],
    left: NDArray[np.bool_],
    seed: int,
    its: BuildingSettings,
) -> NDArray[np.int64]:
    """Connected cells on one line; the line is fitted anew whenever their number has doubled."""
    angle = float(cells.angles[seed])
    normal = np.array([np.cos(angle), np.sin(angle)])
    offset = float(normal @ cells.places[seed])
    members, inside, open_cells = [seed], {seed}, [seed]
    refit_at = 8
    while open_cells:
        near = [each for each in neighbours[open_cells.pop()] if left[each] and each not in inside]
        if near:
            turned = np.angle(np.exp(2j * (cells.angles[near] - angle))) / 2.0
            on_line = np.abs(turned) < its.angle_rad
            on_line &= np.abs(cells.places[near] @ normal - offset) < its.off_line_m
            added = [each for each, fits in zip(near, on_line, strict=True) if fits]
            members.extend(added)
            inside.update(added)
            open_cells.extend(added)
        if len(members) >= refit_at:
            refit_at = 2 * len(members)
            middle, _, normal = _fitted(cells.places[members], cells.hits[members])
            angle = float(np.arctan2(normal[1], normal[0]))
            offset = float(normal @ middle)
    return np.array(members)


def _segments(places: Matrix, hits: Matrix, its: BuildingSettings) -> list[Matrix]:
    """The line through cells, cut at its gaps."""
    middle, along, _ = _fitted(places, np.sqrt(hits))
    reach = np.sort((places - middle) @ along)
    cuts = np.flatnonzero(np.diff(reach) > its.gap_m) + 1
    return [
        np.concatenate((middle + part[0] * along, middle + part[-1] * along))
        for part in np.split(reach, cuts)
        if part[-1] - part[0] > its.shortest_m
    ]


def _fitted(places: Matrix, weights: Matrix) -> tuple[Matrix, Matrix, Matrix]:
    """Middle, direction and normal of the line that fits weighted places best."""
    middle: Matrix = np.average(places, axis=0, weights=weights)
    away = places - middle
    _, axes = np.linalg.eigh((away * weights[:, None]).T @ away)
    return middle, axes[:, 1], axes[:, 0]
