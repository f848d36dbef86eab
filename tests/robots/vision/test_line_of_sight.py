"""How much of the top of a box a camera sees past others."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.vision.line_of_sight import sight_of
from mend.robots.vision.seen_box import SeenBox

EYE = np.array([0.0, 0.0, 1.7])


def box(x: float, y: float, height_m: float, name: str, width_m: float = 0.04) -> SeenBox:
    return SeenBox(x, y, 0.0, (width_m, width_m, height_m), 0.7, name, complete=True)


PART = box(0.5, 0.0, 0.05, "part")


@pytest.mark.parametrize(
    ("others", "share", "hider"),
    [
        ([], 1.0, None),
        ([box(0.6, 0.0, 0.3, "behind")], 1.0, None),
        ([box(0.5, 0.2, 0.3, "aside")], 1.0, None),
        ([box(0.45, 0.0, 0.05, "as low")], 1.0, None),
        ([box(0.45, 0.0, 0.3, "before")], 0.0, "before"),
        ([box(0.45, 0.02, 0.3, "half before")], 0.5, "half before"),
        ([box(0.45, 0.03, 0.3, "less"), box(0.45, -0.02, 0.3, "more")], 0.25, "more"),
    ],
)
def test_what_stands_between_a_camera_and_a_top_hides_it(
    others: list[SeenBox], share: float, hider: str | None
) -> None:
    sight = sight_of(EYE, PART, others)
    assert sight.share == pytest.approx(share, abs=0.09)
    assert (sight.hider and sight.hider.name) == hider


@given(
    st.floats(0.3, 0.7), st.floats(-0.3, 0.3), st.floats(-math.pi, math.pi), st.floats(0.02, 0.3)
)
def test_nothing_hides_more_by_being_looked_at_from_straight_above(
    x: float, y: float, yaw: float, height_m: float
) -> None:
    other = SeenBox(x, y, yaw, (0.05, 0.03, height_m), 0.7, "other", complete=True)
    above = np.array([PART.x, PART.y, 50.0])
    apart = math.hypot(x - PART.x, y - PART.y) > 0.07
    assert not apart or sight_of(above, PART, [other]).share == 1.0
