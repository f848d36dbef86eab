"""The ray cast against its plain definition, and at its edges."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from mend.maps.ray_cast import NOTHING, cast, cast_from_each

Matrix = NDArray[np.float64]


def cast_brute_force(
    segments: Matrix, x: float, y: float, angles: Matrix, max_range: float
) -> tuple[Matrix, NDArray[np.int64]]:
    """Every ray against every segment, as the textbook has it."""
    ranges, indices = [], []
    for angle in angles:
        direction = np.array([np.cos(angle), np.sin(angle)])
        nearest, which = max_range, NOTHING
        for number, (x0, y0, x1, y1) in enumerate(segments):
            edge = np.array([x1 - x0, y1 - y0])
            matrix = np.column_stack((direction, -edge))
            if abs(np.linalg.det(matrix)) < 1e-12:
                continue
            distance, share = np.linalg.solve(matrix, [x0 - x, y0 - y])
            if 0.0 < distance < nearest and 0.0 <= share <= 1.0:
                nearest, which = distance, number
        ranges.append(nearest)
        indices.append(which)
    return np.array(ranges), np.array(indices, dtype=np.int64)


@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 25),
    rays=st.integers(1, 40),
    max_range=st.floats(0.5, 20.0),
)
@settings(max_examples=25, deadline=None)
def test_it_sees_what_the_definition_says(
    seed: int, count: int, rays: int, max_range: float
) -> None:
    generator = np.random.default_rng(seed)
    segments = generator.uniform(-8.0, 8.0, (count, 4))
    angles = generator.uniform(-10.0, 10.0, rays)
    x, y = generator.uniform(-4.0, 4.0, 2)
    ranges, indices = cast(segments, x, y, angles, max_range)
    expected, which = cast_brute_force(segments, x, y, angles, max_range)
    assert ranges == pytest.approx(expected, abs=1e-9)
    assert indices.tolist() == which.tolist()


def test_no_ray_slips_through_a_shared_corner() -> None:
    around = np.linspace(0.0, 2.0 * np.pi, 8)
    corners = np.column_stack((np.cos(around), np.sin(around)))
    ring = np.hstack((corners[:-1], corners[1:]))
    _, indices = cast(ring, 0.0, 0.0, around[:-1], 5.0)
    assert (indices != NOTHING).all()


def test_where_nothing_is_the_range_is_the_largest() -> None:
    ranges, indices = cast(np.array([[1.0, -1.0, 1.0, 1.0]]), 0.0, 0.0, np.array([np.pi]), 7.0)
    assert ranges.tolist() == [7.0]
    assert indices.tolist() == [NOTHING]


def test_an_empty_map_and_no_rays_are_no_trouble() -> None:
    ranges, indices = cast(np.empty((0, 4)), 0.0, 0.0, np.array([0.0, 1.0]), 3.0)
    assert ranges.tolist() == [3.0, 3.0]
    assert indices.tolist() == [NOTHING, NOTHING]
    assert len(cast(np.array([[1.0, 0.0, 1.0, 1.0]]), 0.0, 0.0, np.empty(0), 3.0)[0]) == 0


def test_a_segment_seen_edge_on_hides_nothing() -> None:
    segments = np.array([[1.0, 0.0, 2.0, 0.0], [3.0, -1.0, 3.0, 1.0]])
    ranges, indices = cast(segments, 0.0, 0.0, np.array([0.0]), 10.0)
    assert ranges == pytest.approx([3.0])
    assert indices.tolist() == [1]


@given(seed=st.integers(0, 2**32 - 1), points=st.integers(0, 5), rays=st.integers(0, 9))
def test_from_each_of_many_points_the_same_is_seen(seed: int, points: int, rays: int) -> None:
    rng = np.random.default_rng(seed)
    segments, froms = rng.uniform(-5.0, 5.0, (7, 4)), rng.uniform(-5.0, 5.0, (points, 2))
    angles = rng.uniform(-7.0, 7.0, rays)
    seen = [cast(segments, x, y, angles, 6.0)[0] for x, y in froms.tolist()]
    each = cast_from_each(segments, froms, angles, 6.0)
    assert each.tolist() == np.reshape(seen, (points, rays)).tolist()
