"""Clean-up: every wall once, no slivers, nothing else moved."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.maps.clean_up import clean_up
from mend.maps.vector_map import VectorMap


def test_duplicates_become_one_whichever_way_they_run() -> None:
    cleaned = clean_up(VectorMap.of([[0, 0, 5, 0], [0, 0, 5, 0], [5, 0, 0, 0]]))
    assert len(cleaned) == 1
    assert cleaned.lengths == pytest.approx([5.0])


def test_overlaps_are_joined_along_the_longest() -> None:
    cleaned = clean_up(VectorMap.of([[0, 0, 5, 0], [4, 0.01, 7, 0.01], [6.5, 0, 8, 0]]))
    assert len(cleaned) == 1
    assert sorted(cleaned.segments[0, [0, 2]]) == pytest.approx([0.0, 8.0])
    assert cleaned.segments[0, [1, 3]] == pytest.approx([0.0, 0.0])


def test_slivers_and_points_go() -> None:
    cleaned = clean_up(VectorMap.of([[0, 0, 0.03, 0], [1, 1, 1, 1], [2, 2, 3, 3]]))
    assert cleaned.segments.tolist() == [[2, 2, 3, 3]]


def test_doors_stay_open_and_corners_stay() -> None:
    walls = VectorMap.of([[0, 0, 2, 0], [3, 0, 5, 0], [5, 0, 5, 2], [2, 0, 2, 0.06]])
    assert len(clean_up(walls)) == 4


def test_parallel_walls_stay_two() -> None:
    assert len(clean_up(VectorMap.of([[0, 0, 5, 0], [0, 0.1, 5, 0.1]]))) == 2


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(0, 30))
@settings(max_examples=25, deadline=None)
def test_no_wall_is_lost_and_none_is_made_up(seed: int, count: int) -> None:
    generator = np.random.default_rng(seed)
    # Ends on a coarse grid, so that overlaps and duplicates are common.
    before = VectorMap(generator.integers(0, 4, (count, 4)).astype(float))
    after = clean_up(before)
    for one, other in ((before, after), (after, before)):
        for row, length in zip(one.segments, one.lengths, strict=True):
            if length:
                shares = np.linspace(0.0, 1.0, 15)[:, None]
                for point in row[:2] * (1 - shares) + row[2:] * shares:
                    assert _distance(point, other) < 1e-9


def _distance(point: np.ndarray, vector_map: VectorMap) -> float:
    start = vector_map.segments[:, :2]
    edge = vector_map.segments[:, 2:] - start
    square = np.maximum((edge * edge).sum(axis=1), 1e-12)
    share = np.clip(((point - start) * edge).sum(axis=1) / square, 0.0, 1.0)
    return float(np.hypot(*(start + share[:, None] * edge - point).T).min())
