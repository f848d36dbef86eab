"""Pick and place lays out the paper's eight steps."""

import pytest
from drawn_scene import PARTS, TABLE_Z
from scripted_body import GRIPPER

from mend.robots.arm.behaviors.behavior import Move, SetGripper, Situation
from mend.robots.arm.behaviors.pick_and_place import PickAndPlace, PickAndPlaceParameters
from mend.robots.arm.grasp import RELEASE_CLEARANCE_M, grasp_of
from mend.robots.link.messages import Location

PARAMETERS = PickAndPlaceParameters(object="pink_bar", place="left")
FOUND = Location(x=0.45, y=-0.30, z=TABLE_Z + 0.04, yaw=0.2)
LIFT_M = 0.14
GRASP = grasp_of(PARTS["pink_bar"], GRIPPER)
TARGET = Location(x=0.55, y=0.05)


def lay_out(found=FOUND, target=TARGET, part=PARTS["pink_bar"], clear_z=TABLE_Z):
    situation = Situation(part, found, target, TABLE_Z, GRIPPER, GRASP, clear_z, LIFT_M)
    return PickAndPlace().steps(PARAMETERS, situation)


def test_the_eight_steps_have_their_names_and_actions() -> None:
    steps = lay_out()
    assert len(steps) == PickAndPlace.step_count
    assert [each.name for each in steps] == [
        "above pick",
        "pick",
        "close gripper",
        "above pick",
        "above place",
        "place",
        "open gripper",
        "above place",
    ]
    assert [number for number, each in enumerate(steps, 1) if isinstance(each.action, Move)] == [
        1, 2, 4, 5, 6, 8,
    ]  # fmt: skip
    assert steps[2].action == SetGripper("closed")
    assert steps[6].action == SetGripper("open", GRASP.opening_m)


def test_pick_and_place_heights_come_from_the_grasp() -> None:
    above_pick, pick, *_ = (each.action.to for each in lay_out() if isinstance(each.action, Move))
    place = lay_out()[5].action
    height_m = grasp_of(PARTS["pink_bar"], GRIPPER).height_m
    assert pick.z == pytest.approx(TABLE_Z + 0.04 + height_m)
    assert above_pick.z == pytest.approx(pick.z + LIFT_M)
    assert isinstance(place, Move)
    assert place.to.z == pytest.approx(TABLE_Z + height_m + RELEASE_CLEARANCE_M)
    assert (place.to.x, place.to.y) == (TARGET.x, TARGET.y)


def test_an_object_in_the_gripper_needs_no_pick_pose() -> None:
    carried = lay_out(found=None)
    assert carried[4:] == lay_out()[4:]


def test_an_unknown_place_is_refused() -> None:
    with pytest.raises(ValueError, match="expects a known object and a known place"):
        lay_out(target=None)


def test_what_is_carried_passes_over_what_stands_on_the_way() -> None:
    tall_z = TABLE_Z + 0.25
    poses = [each.action.to for each in lay_out(clear_z=tall_z) if isinstance(each.action, Move)]
    for above in (poses[0], poses[2], poses[3], poses[5]):
        assert above.z - GRASP.height_m >= tall_z


def test_fingers_open_as_wide_as_the_grasp_says() -> None:
    openings = [each.action.opening_m for each in lay_out()]
    assert openings == [GRASP.opening_m] * 2 + [None] * 4 + [GRASP.opening_m] * 2
