"""What the colours in a picture of the hand say of what is between the fingers."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.arm.grip.composition import Composition, likeliest


@pytest.mark.parametrize(
    ("own", "other", "expected"),
    [
        (0.9, 0.0, "right"),
        (0.48, 0.0, "right"),
        (0.0, 0.9, "other"),
        (0.0, 0.0, "nothing"),
        (0.1, 0.0, "nothing"),
    ],
)
def test_the_likeliest_thing_has_most_of_its_colours_in_sight(
    own: float, other: float, expected: str
) -> None:
    assert likeliest(Composition(500, own, other, "other" if other else None)) == expected


@given(share=st.floats(0.4, 1.0), more=st.floats(0.0, 0.6))
def test_more_of_its_own_colour_never_speaks_against_a_part(share: float, more: float) -> None:
    own = min(1.0, share + more)
    assert likeliest(Composition(500, own, 0.0, None)) == "right"
