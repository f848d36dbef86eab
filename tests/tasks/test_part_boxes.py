"""A part is a box, or a plate with the box of its knob on it."""

import pytest

from mend.tasks.part_boxes import boxes_of, height_of

PLATE, KNOB = (0.12, 0.10, 0.02), (0.03, 0.02, 0.04)


def test_a_box_stands_on_its_bottom() -> None:
    assert boxes_of(PLATE, None) == [(0.0, PLATE)]
    assert height_of(PLATE, None) == 0.02


def test_a_knob_stands_on_its_plate() -> None:
    assert boxes_of(PLATE, KNOB) == [(0.0, PLATE), (0.02, KNOB)]
    assert height_of(PLATE, KNOB) == pytest.approx(0.06)
