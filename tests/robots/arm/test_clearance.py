"""Room for the gripper: what stands beside the fingers is in the way, what is lower is not."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scripted_body import GRIPPER

from mend.robots.arm.body import ToolPose
from mend.robots.arm.clearance import beside, in_the_way, room_around
from mend.robots.vision.seen_box import SeenBox
from mend.sim.workcell.gripper import PR2_GRIPPER

TOOL = ToolPose(0.5, -0.2, 0.73, 0.0)
OPENING_M = 0.05
MARGIN_M = 0.002
# The tips reach 10 mm below the tool point; a finger is 10 mm thick and 20 mm wide.
NEIGHBOUR = SeenBox(0.5, -0.2, 0.0, (0.03, 0.03, 0.05), 0.7, "other", complete=True)
ANGLES = st.floats(-math.pi, math.pi)


def touches(box: SeenBox, tool: ToolPose = TOOL, opening_m: float = OPENING_M) -> bool:
    return in_the_way(GRIPPER, tool, opening_m, [box], MARGIN_M) is not None


@pytest.mark.parametrize(
    ("along_m", "aside_m", "height_m", "so"),
    [
        (0.0, 0.0, 0.05, False),
        (0.030, 0.0, 0.05, True),
        (0.030, 0.0, 0.015, False),
        (0.030, 0.030, 0.05, False),
        (0.055, 0.0, 0.05, False),
        (0.045, 0.0, 0.05, True),
        (0.0, 0.045, 0.15, False),
        (0.0, 0.030, 0.15, True),
    ],
)
def test_only_what_is_under_a_finger_or_the_palm_is_in_the_way(
    along_m: float, aside_m: float, height_m: float, so: bool
) -> None:
    x, y = TOOL.x + along_m, TOOL.y + aside_m
    assert touches(replace(NEIGHBOUR, x=x, y=y, size=(0.03, 0.03, height_m))) is so


@given(turn=ANGLES, away=st.floats(0.0, 0.12), direction=ANGLES, yaw=ANGLES)
def test_turning_everything_changes_nothing(
    turn: float, away: float, direction: float, yaw: float
) -> None:
    def at(extra: float) -> bool:
        x = TOOL.x + away * math.cos(direction + extra)
        y = TOOL.y + away * math.sin(direction + extra)
        box = replace(NEIGHBOUR, x=x, y=y, yaw=yaw + extra)
        return touches(box, replace(TOOL, yaw=extra))

    # At the very border rounding may decide.
    if at(0.0) is not at(1e-9):
        return
    assert at(turn) in (at(0.0), at(turn + 1e-7))


@given(along=st.floats(-0.1, 0.1), aside=st.floats(-0.1, 0.1), higher=st.floats(0.0, 0.2))
def test_a_gripper_that_is_higher_touches_no_more(
    along: float, aside: float, higher: float
) -> None:
    box = replace(NEIGHBOUR, x=TOOL.x + along, y=TOOL.y + aside)
    if touches(box, replace(TOOL, z=TOOL.z + higher)):
        assert touches(box)


@pytest.mark.parametrize(
    ("along_m", "height_m", "room_m"),
    [
        # A finger reaches from 25 to 35 mm along; the box is 30 mm wide.
        (0.055, 0.05, 0.005),
        (0.030, 0.014, 0.006),
        (0.055, 0.014, 0.006),
        (0.030, 0.05, 0.0),
    ],
)
def test_room_is_what_is_left_beside_or_under_the_fingers(
    along_m: float, height_m: float, room_m: float
) -> None:
    near = replace(NEIGHBOUR, x=TOOL.x + along_m, size=(0.03, 0.03, height_m))
    far = replace(near, x=near.x + 0.2)
    found = room_around(GRIPPER, TOOL, OPENING_M, [far, near])
    assert found is not None
    assert found.to == near
    assert found.room_m == pytest.approx(room_m)


def test_without_anything_around_there_is_all_the_room() -> None:
    assert room_around(GRIPPER, TOOL, OPENING_M, []) is None


def test_what_may_stray_leaves_less_room_beside_the_fingers_but_not_under_them() -> None:
    aside = replace(NEIGHBOUR, x=TOOL.x + 0.055)
    under = replace(NEIGHBOUR, x=TOOL.x + 0.030, size=(0.03, 0.03, 0.014))
    room = [room_around(GRIPPER, TOOL, OPENING_M, [box], stray_m=0.003) for box in (aside, under)]
    assert [each.room_m for each in room if each] == pytest.approx([0.002, 0.006])


def test_fingers_that_come_down_as_they_close_touch_what_they_pass_over_open() -> None:
    width_m, opening_m = 0.021, 0.045
    open_z = TOOL.z - PR2_GRIPPER.reach_below_m(opening_m)
    closed_z = TOOL.z - PR2_GRIPPER.reach_below_m(width_m)
    assert open_z - closed_z > 0.002
    plate = replace(NEIGHBOUR, x=TOOL.x + 0.035, size=(0.03, 0.03, (open_z + closed_z) / 2 - 0.7))
    apart = in_the_way(PR2_GRIPPER, TOOL, opening_m, [plate], 0.0005)
    closing = in_the_way(PR2_GRIPPER, TOOL, opening_m, [plate], 0.0005, closed_m=width_m)
    assert (apart, closing) == (None, plate)


def test_boxes_are_beside_each_other_by_the_gap_between_their_sides() -> None:
    other = replace(NEIGHBOUR, x=NEIGHBOUR.x + 0.05)
    assert beside(NEIGHBOUR, [other], 0.021)
    assert not beside(NEIGHBOUR, [other], 0.019)
    assert not beside(NEIGHBOUR, [], 0.1)
