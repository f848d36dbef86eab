"""Points of one scan that another one saw: found in a few buckets, and none missed."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import cKDTree

from mend.localization.enml.point_buckets import PointBuckets
from mend.localization.points import ScanPoints
from mend.localization.pose import transform, turn

CELL_M = 0.15
ALIKE = float(np.cos(np.radians(25.0)))
COORDINATES = st.integers(-300, 300).map(lambda cm: cm / 100.0)


def scan(points: np.ndarray, headings: np.ndarray) -> ScanPoints:
    normals = np.column_stack((np.cos(headings), np.sin(headings)))
    return ScanPoints(points, normals, np.arange(len(points)))


@st.composite
def scans(draw: st.DrawFn) -> ScanPoints:
    count = draw(st.integers(0, 40))
    points = draw(arrays(np.float64, (count, 2), elements=COORDINATES))
    # No two points are equally far from a third.
    points += np.linspace(0.0, 1e-3, 2 * count).reshape(count, 2) ** 2
    return scan(points, draw(arrays(np.float64, count, elements=st.floats(-4.0, 4.0))))


MOTIONS = st.tuples(COORDINATES, COORDINATES, st.floats(-3.0, 3.0)).map(np.array)


@given(scans(), scans(), MOTIONS)
def test_the_same_is_found_as_in_a_tree_of_all_points(
    mine: ScanPoints, other: ScanPoints, motion: np.ndarray
) -> None:
    every = np.arange(len(other))
    found = PointBuckets.of(mine, CELL_M).same_surface(other, every, motion, ALIKE)
    pairs = dict(zip(found[1].tolist(), found[0].tolist(), strict=True))
    assert list(pairs) == sorted(pairs)
    away_m, nearest = (
        cKDTree(mine.points).query(transform(motion, other.points))
        if len(mine)
        else (np.full(len(other), np.inf), every)
    )
    normals = turn(float(motion[2]), other.normals)
    for row in every.tolist():
        if away_m[row] >= CELL_M + 1e-9:
            assert row not in pairs
        elif away_m[row] < CELL_M - 1e-9:
            cosine = float(normals[row] @ mine.normals[nearest[row]])
            if abs(cosine - ALIKE) > 1e-9:
                assert (row in pairs) == (cosine > ALIKE)
        if row in pairs:
            gap_m = np.hypot(*(mine.points[pairs[row]] - transform(motion, other.points)[row]))
            assert abs(gap_m - away_m[row]) < 1e-9


def test_only_what_is_looked_for_is_found() -> None:
    points = np.array([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]])
    one = scan(points, np.zeros(3))
    mine, other = PointBuckets.of(one, CELL_M).same_surface(
        one, np.array([2, 0]), np.zeros(3), ALIKE
    )
    assert mine.tolist() == other.tolist() == [2, 0]


def test_what_has_no_normal_is_never_the_same() -> None:
    bare = ScanPoints(np.array([[1.0, 0.0]]), np.zeros((1, 2)), np.arange(1))
    mine, _ = PointBuckets.of(bare, CELL_M).same_surface(bare, np.arange(1), np.zeros(3), ALIKE)
    assert not len(mine)
