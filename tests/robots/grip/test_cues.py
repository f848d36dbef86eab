"""The likelihoods: each cue says what it can, and nothing where it cannot tell."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scripted_body import GRIPPER

from robots.grip.composition import Composition
from robots.grip.cues import CueModel, HandReading

CUES = CueModel()
WIDTHS = st.floats(GRIPPER.min_width_m + 0.002, GRIPPER.max_width_m)
OWN = Composition(60, 0.9, 0.0, None)
OTHERS = Composition(60, 0.0, 0.9, "another")
NOBODYS = Composition(60, 0.0, 0.0, None)


def ratio(width_m: float, opening_m: float, presses: bool, seen: Composition | None) -> float:
    return CUES.log_ratio(HandReading(opening_m, presses, seen), width_m, GRIPPER)


@given(width_m=WIDTHS)
def test_the_right_width_is_for_it_and_closed_fingers_against_it_for_every_part(width_m) -> None:
    assert ratio(width_m, width_m, True, None) > 2.0
    assert ratio(width_m, 0.0, False, None) < -8.0
    assert ratio(width_m, 0.0, True, None) < -4.0


@given(width_m=WIDTHS, opening_m=st.floats(0.0, 0.09), presses=st.booleans())
def test_its_own_colours_never_speak_against_a_part_and_others_never_for_it(
    width_m, opening_m, presses
) -> None:
    blind = ratio(width_m, opening_m, presses, None)
    assert ratio(width_m, opening_m, presses, OWN) > blind
    assert ratio(width_m, opening_m, presses, OTHERS) < blind


@given(width_m=WIDTHS, opening_m=st.floats(0.0, 0.09))
def test_fingers_that_do_not_press_speak_against_it(width_m, opening_m) -> None:
    assert ratio(width_m, opening_m, False, None) < ratio(width_m, opening_m, True, None)


@pytest.mark.parametrize("width_m", [0.012, 0.03, 0.06])
def test_a_dim_picture_alone_does_not_outweigh_the_fingers(width_m: float) -> None:
    assert ratio(width_m, width_m, True, NOBODYS) > 0.0


@pytest.mark.parametrize("width_m", [0.012, 0.03, 0.06])
def test_other_colours_outweigh_the_right_width(width_m: float) -> None:
    assert ratio(width_m, width_m, True, OTHERS) < 0.0
