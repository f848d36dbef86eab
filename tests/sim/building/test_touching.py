"""Something round touches a wall where the nearest is nearer than its radius."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mend.maps.building.clearance import distances_m
from mend.sim.building.touching import touches_any

METRES = st.floats(-5.0, 5.0)
SEGMENTS = st.lists(st.tuples(METRES, METRES, METRES, METRES), max_size=6)


@given(segments=SEGMENTS, x=METRES, y=METRES, radius_m=st.floats(0.1, 2.0))
def test_it_is_by_the_distance_to_the_nearest(
    segments: list[tuple[float, float, float, float]], x: float, y: float, radius_m: float
) -> None:
    walls = np.array(segments, np.float64).reshape(-1, 4)
    away_m = distances_m(np.array([[x, y]]), walls)[0]
    assert touches_any(walls, x, y, radius_m) == (away_m < radius_m)


def test_one_that_has_no_length_is_touched_as_well() -> None:
    post = np.array([[1.0, 1.0, 1.0, 1.0]])
    assert touches_any(post, 1.0, 1.4, 0.5)
    assert not touches_any(post, 1.0, 1.6, 0.5)
