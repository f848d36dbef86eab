"""The likelihoods: each cue says what it can, and nothing where it cannot tell."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scripted_body import GRIPPER

from mend.robots.arm.grasp import Grasp
from mend.robots.arm.grip.belief import Belief, Between
from mend.robots.arm.grip.composition import Composition
from mend.robots.arm.grip.cues import CueModel, HandReading
from mend.robots.arm.grip.rivals import RivalReading

CUES = CueModel()
WIDTHS = st.floats(GRIPPER.min_width_m + 0.002, GRIPPER.max_width_m)
OWN = Composition(60, 0.9, 0.0, None)
OTHERS = Composition(60, 0.0, 0.9, "another")
NOBODYS = Composition(60, 0.0, 0.0, None)


def grasp(width_m: float, across_m: float | None = None) -> Grasp:
    across_m = width_m if across_m is None else across_m
    return Grasp(0.02, 0.0, width_m, across_m, width_m + 0.024)


def log_odds(
    width_m: float,
    opening_m: float,
    presses: bool,
    seen: Composition | None,
    across_m: float | None = None,
) -> float:
    """Of the part being held, after one reading; where little doubt is left it may not change."""
    reading = HandReading(opening_m, presses, seen)
    belief = Belief()
    belief.update(CUES.log_likelihoods(reading, grasp(width_m, across_m), GRIPPER))
    return math.log(belief.probability / (1.0 - belief.probability))


@given(width_m=WIDTHS)
def test_the_right_width_is_for_it_and_closed_fingers_against_it_for_every_part(width_m) -> None:
    assert log_odds(width_m, width_m, True, None) > 2.0
    assert log_odds(width_m, 0.0, False, None) < -5.0
    assert log_odds(width_m, 0.0, True, None) < -4.0


@given(width_m=WIDTHS, opening_m=st.floats(0.0, 0.09), presses=st.booleans())
def test_its_own_colours_never_speak_against_a_part_and_others_never_for_it(
    width_m, opening_m, presses
) -> None:
    blind = log_odds(width_m, opening_m, presses, None)
    assert log_odds(width_m, opening_m, presses, OWN) >= blind - 0.01
    assert log_odds(width_m, opening_m, presses, OTHERS) <= blind + 0.01


@given(width_m=WIDTHS, opening_m=st.floats(0.0, 0.09))
def test_fingers_that_do_not_press_never_speak_for_it(width_m, opening_m) -> None:
    pressing = log_odds(width_m, opening_m, True, None)
    assert log_odds(width_m, opening_m, False, None) <= pressing + 1e-9


@pytest.mark.parametrize("width_m", [0.012, 0.03, 0.06])
def test_a_dim_picture_alone_does_not_outweigh_the_fingers(width_m: float) -> None:
    assert log_odds(width_m, width_m, True, NOBODYS) > 0.0


@pytest.mark.parametrize("width_m", [0.012, 0.03, 0.06])
def test_other_colours_outweigh_the_right_width(width_m: float) -> None:
    assert log_odds(width_m, width_m, True, OTHERS) < 0.0


@pytest.mark.parametrize("across_m", [0.02, 0.022, 0.026])
@pytest.mark.parametrize("share", [0.5, 1.0])
def test_on_an_almost_square_part_fingers_may_be_up_to_its_diagonal_apart(across_m, share) -> None:
    held = grasp(0.02, across_m)
    opening_m = across_m + share * (held.diagonal_m - across_m)
    logs = CUES.log_likelihoods(HandReading(opening_m, True, None), held, GRIPPER)
    assert logs[Between.TURNED] > logs[Between.OTHER]


@given(width_m=st.floats(0.02, 0.04), across_m=st.floats(0.02, 0.04))
def test_a_part_may_lie_the_other_way_round(width_m, across_m) -> None:
    logs = CUES.log_likelihoods(
        HandReading(across_m, True, None), grasp(width_m, across_m), GRIPPER
    )
    assert logs[Between.TURNED] > logs[Between.OTHER]


@given(width_m=st.floats(0.02, 0.04), wider_m=st.floats(0.006, 0.015))
def test_no_long_part_is_held_askew(width_m, wider_m) -> None:
    """Flat fingers turn it straight; so it is something else, even of its colour."""
    long_m = 4 * width_m
    assert log_odds(width_m, width_m + wider_m, True, OWN, long_m) < 0.0


@given(width_m=WIDTHS, wider_m=st.floats(0.004, 0.02))
def test_a_wider_stranger_is_no_turned_part_where_no_way_round_is_so_wide(width_m, wider_m) -> None:
    diagonal_m = grasp(width_m).diagonal_m
    assert log_odds(width_m, diagonal_m + 0.004 + wider_m, True, OWN) < 0.0


@given(width_m=st.floats(0.012, 0.04), wider_m=st.floats(0.0, 0.03))
def test_what_something_pushes_may_be_askew_however_long_it_is(width_m, wider_m) -> None:
    reading = HandReading(width_m + wider_m, True, OWN, pushed=True)
    logs = CUES.log_likelihoods(reading, grasp(width_m, 5 * width_m), GRIPPER)
    assert logs[Between.TURNED] > logs[Between.OTHER]


@given(width_m=st.floats(0.02, 0.07), share=st.floats(0.3, 1.0))
def test_what_something_pushes_may_be_held_by_a_corner(width_m, share) -> None:
    belief = Belief()
    for _ in range(12):
        reading = HandReading(share * width_m, True, OWN, pushed=True)
        belief.update(CUES.log_likelihoods(reading, grasp(width_m), GRIPPER))
    assert belief.probability > 0.9


@given(width_m=WIDTHS)
def test_fingers_that_close_tell_that_it_is_gone_even_while_something_pushes(width_m) -> None:
    belief = Belief()
    for _ in range(20):
        belief.update(
            CUES.log_likelihoods(HandReading(width_m, True, OWN), grasp(width_m), GRIPPER)
        )
    for _ in range(3):
        closed = HandReading(0.0, False, None, pushed=True)
        belief.update(CUES.log_likelihoods(closed, grasp(width_m), GRIPPER))
    assert belief.probability < 0.01


@pytest.mark.parametrize("rivals", [1, 3, 10])
def test_a_rival_that_fits_each_reading_is_believed_however_many_others_there_are(
    rivals: int,
) -> None:
    knob, other = grasp(0.015, 0.024), 0.022
    widths = [other, *(0.040 + 0.002 * each for each in range(rivals - 1))]
    reading = HandReading(
        other, True, None, rivals=[RivalReading(each, 0.0, alike=True) for each in widths]
    )
    belief = Belief(rivals)
    for _ in range(12):
        belief.update(CUES.log_likelihoods(reading, knob, GRIPPER))
    assert belief.probability < 0.05


def test_rivals_that_are_forgotten_are_something_else() -> None:
    reading = HandReading(0.03, True, None, rivals=[RivalReading(0.03, 0.0, alike=True)])
    belief = Belief(1)
    belief.update(CUES.log_likelihoods(reading, grasp(0.015), GRIPPER))
    before = belief.probability
    belief.forget_rivals()
    assert belief.probability == pytest.approx(before)
    assert belief.of(Between.OTHER) > 0.5


@pytest.mark.parametrize(("alike", "believed"), [(True, True), (False, False)])
def test_fingers_tell_what_is_hardly_wider_only_where_its_looks_can_tell_too(
    alike: bool, believed: bool
) -> None:
    wider = grasp(0.030).width_m + 0.002
    reading = HandReading(wider, True, None, rivals=[RivalReading(wider, 0.0, alike)])
    belief = Belief(1)
    for _ in range(12):
        belief.update(CUES.log_likelihoods(reading, grasp(0.030), GRIPPER))
    assert (belief.probability > 0.5) is believed
