"""What a camera's picture holds."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.vision.viewpoint import Viewpoint

AHEAD = Viewpoint(np.eye(4), (640, 480), 500.0, (319.5, 239.5))


def test_a_point_behind_the_camera_is_not_in_its_picture() -> None:
    assert AHEAD.shows(np.array([[0.0, 0.0, 1.0]]))
    assert not AHEAD.shows(np.array([[0.0, 0.0, -1.0]]))


@given(
    st.floats(-50.0, 700.0),
    st.floats(-50.0, 530.0),
    st.floats(0.1, 5.0),
    st.floats(0.0, 20.0),
)
def test_a_picture_holds_what_its_pixels_show(
    u: float, v: float, depth_m: float, margin_px: float
) -> None:
    point = np.array([[(u - 319.5) / 500 * depth_m, (v - 239.5) / 500 * depth_m, depth_m]])
    held_px = min(u, 639.0 - u, v, 479.0 - v)
    if abs(held_px - margin_px) > 1e-6:
        assert AHEAD.shows(point, margin_px) is (held_px > margin_px)


def test_what_reaches_beyond_the_picture_is_not_in_it() -> None:
    points = np.array([[0.0, 0.0, 1.0], [0.8, 0.0, 1.0]])
    assert AHEAD.shows(points[:1])
    assert not AHEAD.shows(points)
