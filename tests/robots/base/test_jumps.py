"""Whether a pose leaves where the wheels have led."""

import math

from hypothesis import given
from hypothesis import strategies as st

from mend.robots.base.body import BasePose
from mend.robots.base.jumps import Jumps

METRES = st.floats(-20.0, 20.0)
RADIANS = st.floats(-math.pi, math.pi)


@given(METRES, METRES, RADIANS, RADIANS, st.floats(-2.0, 2.0), RADIANS)
def test_who_drives_does_not_jump_in_whatever_frame_its_wheels_count(
    x: float, y: float, yaw: float, wheels_yaw: float, ahead_m: float, turned: float
) -> None:
    jumps = Jumps()
    assert not jumps.note(BasePose(x, y, yaw), BasePose(1.0, 2.0, wheels_yaw))
    ahead = BasePose(x + ahead_m * math.cos(yaw), y + ahead_m * math.sin(yaw), yaw + turned)
    wheels = BasePose(
        1.0 + ahead_m * math.cos(wheels_yaw),
        2.0 + ahead_m * math.sin(wheels_yaw),
        wheels_yaw + turned,
    )
    assert not jumps.note(ahead, wheels)


def test_a_pose_that_leaves_the_wheels_behind_jumps_once() -> None:
    jumps, wheels = Jumps(), BasePose(0.0, 0.0, 0.0)
    jumps.note(BasePose(0.0, 0.0, 0.0), wheels)
    assert jumps.note(BasePose(1.0, 0.0, 0.0), wheels)
    assert not jumps.note(BasePose(1.0, 0.0, 0.0), wheels)
    assert jumps.note(BasePose(1.0, 0.0, 1.0), wheels)
