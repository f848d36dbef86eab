"""Walls out of laser hits."""

import numpy as np
import pytest

from mend.maps.building_vector_map import build_vector_map


def _wall(x0: float, y0: float, x1: float, y1: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Hits along a wall with 1 cm of noise, and its normal at each."""
    generator = np.random.default_rng(seed)
    length = np.hypot(x1 - x0, y1 - y0)
    normal = np.array([y0 - y1, x1 - x0]) / length
    shares = generator.random(int(length * 200))[:, None]
    points = np.array([x0, y0]) * (1 - shares) + np.array([x1, y1]) * shares
    points += generator.normal(0.0, 0.01, len(points))[:, None] * normal
    return points, np.tile(normal, (len(points), 1))


def test_two_walls_with_a_door_between_become_two_segments() -> None:
    parts = [_wall(0, 1, 3, 1, 1), _wall(4, 1, 6, 1, 2)]
    vector_map = build_vector_map(*map(np.vstack, zip(*parts, strict=True)), name="hall")
    assert vector_map.name == "hall"
    assert len(vector_map) == 2
    assert sorted(vector_map.lengths) == pytest.approx([2.0, 3.0], abs=0.06)
    assert vector_map.segments[:, [1, 3]] == pytest.approx(1.0, abs=0.01)


def test_a_corner_becomes_two_segments() -> None:
    parts = [_wall(0, 0, 3, 0, 1), _wall(3, 0, 3, 3, 2)]
    vector_map = build_vector_map(*map(np.vstack, zip(*parts, strict=True)))
    assert len(vector_map) == 2
    assert sorted(vector_map.lengths) == pytest.approx([3.0, 3.0], abs=0.1)


def test_scattered_hits_are_no_wall() -> None:
    generator = np.random.default_rng(5)
    points = generator.uniform(0, 20, (300, 2))
    angles = generator.uniform(0, np.pi, 300)
    normals = np.column_stack((np.cos(angles), np.sin(angles)))
    assert len(build_vector_map(points, normals)) == 0


def test_points_without_normals_give_an_empty_map() -> None:
    assert len(build_vector_map(np.ones((5, 2)), np.zeros((5, 2)))) == 0
    assert len(build_vector_map(np.empty((0, 2)), np.empty((0, 2)))) == 0
