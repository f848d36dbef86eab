"""Furniture of a building: off the lanes, in front of walls, and the same again by its draws."""

import numpy as np
import pytest
from building_bench import made_up
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.maps.building.building import Floor
from mend.maps.building.clearance import distances_m
from mend.sim.building.furniture import Furniture, Room, kept_clear

CLEAR_M = 0.45


def floor_of(seed: int) -> Floor:
    return made_up(1, 4 + seed % 8, seed).floors["F1"]


def furnished(floor: Floor, share: float, seed: int = 1) -> Furniture:
    room = Room(floor, kept_clear(floor, []), CLEAR_M)
    return Furniture({"F1": room}, share, np.random.default_rng(seed))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 1000), st.sampled_from([0.1, 0.33]))
def test_nothing_stands_on_lanes_or_in_walls_wherever_it_is_moved(seed: int, share: float) -> None:
    floor = floor_of(seed)
    furniture = furnished(floor, share, seed)
    for _ in range(5):
        furniture.move_one("F1", [], 1.0)
    lanes = kept_clear(floor, [])
    for piece in furniture.on("F1"):
        assert distances_m(piece.samples, lanes).min() >= CLEAR_M
        assert distances_m(piece.samples, floor.vector_map.segments).min() > 0.05


def test_there_is_as_much_as_was_asked_for() -> None:
    assert furnished(floor_of(7), 0.33).share("F1") == pytest.approx(0.33, abs=0.05)
    assert len(furnished(floor_of(7), 0.0).on("F1")) == 0


def test_what_is_moved_does_not_come_near_anybody() -> None:
    floor = floor_of(7)
    furniture = furnished(floor, 0.2)
    before = set(furniture.on("F1"))
    stand = [(each.x, each.y) for each in floor.places.values()]
    for _ in range(20):
        furniture.move_one("F1", stand, 1.0)
    moved = [each for each in furniture.on("F1") if each not in before]
    assert len(furniture.on("F1")) == len(before)
    for piece in moved:
        assert distances_m(np.array(stand), piece.segments).min() > 1.0


def test_it_is_put_back_from_its_rows() -> None:
    floor = floor_of(7)
    furniture, other = furnished(floor, 0.2), furnished(floor, 0.1, seed=2)
    other.restore(furniture.rows())
    assert np.array_equal(other.segments("F1"), furniture.segments("F1"))
    with pytest.raises(ValueError, match="other floors"):
        other.restore({})


def test_a_floor_without_lanes_stays_empty() -> None:
    assert len(furnished(Floor(walls=((0.0, 0.0, 5.0, 0.0),)), 0.3).on("F1")) == 0
