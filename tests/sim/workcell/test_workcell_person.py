"""Every intervention does what it says, or says in a sentence why it cannot."""

import math

import numpy as np
import pytest
from workcell_hands import TABLE_M, Hands, distance_m, do

from mend.robots.arm.body import ToolPose
from mend.sim.acts import HAND_OVER_S
from mend.sim.workcell.parts import PartPose
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.intervention import Act
from mend.tasks.scene import Pose


def seen(world: WorkcellWorld, name: str) -> bool:
    """Whether any pixel of a head picture shows a part."""
    _, rendering = world.head.capture_with_bodies()
    return bool((rendering.bodies == world.parts[name].body_id).any())


def test_a_stolen_part_is_gone_from_the_table(world: WorkcellWorld) -> None:
    assert seen(world, "bar")
    assert do(world, Act.STEAL, "bar") == ""
    assert world.parts["bar"].stolen
    assert not seen(world, "bar")


def test_a_part_that_is_gone_cannot_be_stolen_again(world: WorkcellWorld) -> None:
    do(world, Act.STEAL, "bar")
    assert do(world, Act.STEAL, "bar") == "'bar' is gone already"


def test_an_object_that_the_scene_does_not_have_is_named(world: WorkcellWorld) -> None:
    assert do(world, Act.STEAL, "spoon") == "the scene has no object 'spoon'"


def test_what_is_done_in_buildings_only_cannot_be_done_here(world: WorkcellWorld) -> None:
    said = "there is nothing at a table for which anybody could do 'charge'"
    assert do(world, Act.CHARGE, None) == said


def test_a_stolen_part_is_put_back_where_it_started(hands: Hands) -> None:
    start = hands.world.parts["bar"].pose()
    do(hands.world, Act.STEAL, "bar")
    assert do(hands.world, Act.PUT_BACK, "bar") == ""
    hands.wait(0.2)
    assert distance_m(hands.world.parts["bar"].pose(), start) < 0.001
    assert seen(hands.world, "bar")


def test_a_part_is_put_to_its_place(hands: Hands) -> None:
    assert do(hands.world, Act.PLACE, "bar", place="right") == ""
    hands.wait(0.2)
    place = PartPose.upright(0.40, 0.05, TABLE_M, 0.4)
    assert distance_m(hands.world.parts["bar"].pose(), place) < 0.001
    assert hands.world.parts["bar"].pose().yaw == pytest.approx(0.4, abs=0.01)


def test_a_place_has_to_be_named_and_known(world: WorkcellWorld) -> None:
    assert "does not say at which place" in do(world, Act.PLACE, "bar")
    assert do(world, Act.PLACE, "bar", place="sink") == "the scene has no place 'sink'"


def test_a_part_is_moved_somewhere_else(hands: Hands) -> None:
    assert do(hands.world, Act.MOVE, "plate", to=Pose(x=0.70, y=-0.60)) == ""
    hands.wait(0.2)
    there = PartPose.upright(0.70, -0.60, TABLE_M, 0.0)
    assert distance_m(hands.world.parts["plate"].pose(), there) < 0.001


def test_nothing_is_put_beside_the_table(world: WorkcellWorld) -> None:
    assert do(world, Act.MOVE, "bar", to=Pose(x=2.0, y=0.0)) == "(2.0, 0.0) is not on the table"


def test_nothing_is_put_into_another_part(world: WorkcellWorld) -> None:
    before = world.parts["bar"].pose()
    leg = world.parts["leg"].pose().position
    problem = do(world, Act.MOVE, "bar", to=Pose(x=leg[0], y=leg[1]))
    assert problem.startswith("'leg' is at (")
    assert problem.endswith("so 'bar' cannot be put there")
    assert distance_m(world.parts["bar"].pose(), before) < 1e-6


def test_nothing_is_brought_back_to_where_something_else_lies(world: WorkcellWorld) -> None:
    x, y, _ = world.parts["bar"].pose().position
    do(world, Act.STEAL, "bar")
    do(world, Act.MOVE, "leg", to=Pose(x=x, y=y))
    assert (
        do(world, Act.PUT_BACK, "bar")
        == "'leg' is where 'bar' started, so 'bar' cannot be put there"
    )
    assert world.parts["bar"].stolen


@pytest.mark.slow
def test_nothing_is_brought_back_into_a_plate_with_a_knob(hands: Hands) -> None:
    world = hands.world
    x, y, _ = world.parts["plate"].pose().position
    do(world, Act.STEAL, "leg")
    hands.wait(5.0)
    problem = do(world, Act.MOVE, "leg", to=Pose(x=x, y=y))
    assert problem.endswith("so 'leg' cannot be put there")
    assert world.parts["leg"].stolen


@pytest.mark.slow
def test_a_part_vanishes_from_between_the_fingers(hands: Hands) -> None:
    hands.pick("bar")
    assert do(hands.world, Act.STEAL, "bar") == ""
    hands.wait(0.3)
    assert hands.world.held is None
    assert hands.body.gripper_opening_m() < 0.005


@pytest.mark.slow
@pytest.mark.parametrize("name", ["leg", "bar", "plate"])
def test_a_pulled_part_slides_out_of_the_fingers_and_is_gone(hands: Hands, name: str) -> None:
    hands.pick(name)
    tool = hands.body.tool_pose()[:3, 3]
    assert do(hands.world, Act.STEAL, name, manner="pull") == ""
    hands.wait(0.1)
    assert not hands.world.parts[name].stolen
    hands.wait(0.7)
    away = np.linalg.norm(np.array(hands.world.parts[name].pose().position) - tool)
    assert away > 0.12
    hands.wait(0.7)
    assert hands.world.parts[name].stolen
    assert hands.world.held is None
    # The hand is gone with the part: what comes back stays where it is put.
    assert do(hands.world, Act.PUT_BACK, name) == ""
    hands.wait(1.0)
    assert distance_m(hands.world.parts[name].pose(), hands.world.parts[name].start) < 0.001


@pytest.mark.slow
def test_what_the_robot_holds_is_put_back_out_of_its_gripper(hands: Hands) -> None:
    hands.pick("bar")
    start = hands.world.parts["bar"].start
    hands.follow(hands.plan(ToolPose(0.5, 0.0, TABLE_M + 0.2, math.pi / 2)), 0, 0.75)
    assert do(hands.world, Act.PUT_BACK, "bar") == ""
    hands.wait(0.3)
    assert hands.world.held is None
    assert distance_m(hands.world.parts["bar"].pose(), start) < 0.001


@pytest.mark.slow
@pytest.mark.parametrize("name", ["leg", "bar", "plate"])
def test_a_part_is_handed_over_and_then_placed(hands: Hands, name: str) -> None:
    hands.go_hand_over()
    assert do(hands.world, Act.HAND_OVER, name) == ""
    hands.wait(0.3)
    assert hands.world.held is None
    hands.body.close_gripper()
    hands.settle()
    hands.wait(0.2)
    assert hands.world.held == name
    place = PartPose.upright(0.55, 0.0, TABLE_M, 0.0)
    hands.place(name, place)
    assert distance_m(hands.world.parts[name].pose(), place) < 0.004


@pytest.mark.slow
def test_a_person_waits_with_a_part_until_the_gripper_is_ready(hands: Hands) -> None:
    assert do(hands.world, Act.STEAL, "bar") == ""
    hands.body.follow(hands.body.plan_hand_over(), 0, 1.0)
    assert do(hands.world, Act.HAND_OVER, "bar") == ""
    tool = hands.body.tool_pose()[:3, 3]
    hands.settle()
    hands.wait(0.1)
    tool = hands.body.tool_pose()[:3, 3]
    assert np.linalg.norm(np.array(hands.world.parts["bar"].pose().position) - tool) < 0.05


@pytest.mark.slow
def test_a_part_that_nobody_takes_is_put_down_again(hands: Hands) -> None:
    start = hands.world.parts["bar"].pose()
    hands.go_hand_over()
    do(hands.world, Act.HAND_OVER, "bar")
    hands.wait(HAND_OVER_S + 0.5)
    assert distance_m(hands.world.parts["bar"].pose(), start) < 0.002


def test_two_parts_are_not_handed_over_at_once(world: WorkcellWorld) -> None:
    do(world, Act.HAND_OVER, "bar")
    assert do(world, Act.HAND_OVER, "leg") == "somebody is handing over 'bar' already"


@pytest.mark.slow
def test_who_stands_in_the_way_is_felt_and_hurts_no_part(hands: Hands) -> None:
    hands.pick("bar")
    others = {name: hands.world.parts[name].pose() for name in ("leg", "plate")}
    path = hands.plan(ToolPose(0.5, 0.05, TABLE_M + 0.16, math.pi / 2))
    hands.body.follow(path, 0, 0.75)
    hands.wait(0.2)
    assert do(hands.world, Act.BLOCK) == ""
    pushed = 0

    def feel() -> bool:
        nonlocal pushed
        pushed = pushed + 1 if hands.body.contact_force_n() > 20.0 else 0
        return pushed >= 4

    hands.settle(feel)
    assert pushed >= 4
    hands.body.stop()
    hands.wait(0.3)
    assert hands.world.held == "bar"
    assert do(hands.world, Act.RELEASE) == ""
    hands.wait(0.1)
    assert hands.body.contact_force_n() < 8.0
    hands.follow(path, 0, 0.75)
    assert abs(hands.body.tool_pose()[1, 3] - 0.05) < 0.001
    for name, pose in others.items():
        assert distance_m(hands.world.parts[name].pose(), pose) < 0.001


def test_only_one_stands_in_the_way(world: WorkcellWorld) -> None:
    assert do(world, Act.RELEASE) == "nobody stands in the way"
    assert do(world, Act.BLOCK) == ""
    assert do(world, Act.BLOCK) == "somebody stands in the way already"
    assert do(world, Act.RELEASE) == ""


@pytest.mark.slow
def test_an_arm_that_does_not_stop_is_held_up_and_then_stays(hands: Hands) -> None:
    path = hands.plan(ToolPose(0.5, 0.05, TABLE_M + 0.25, 0.0))
    hands.body.follow(path, 0, 0.5)
    hands.wait(0.2)
    assert do(hands.world, Act.BLOCK) == ""
    forces = []

    def feel() -> bool:
        forces.append(hands.body.contact_force_n())
        return False

    hands.settle(feel)
    assert sum(force > 150.0 for force in forces) > 20
    stuck = hands.body.tool_pose()[:3, 3]
    assert stuck[1] < 0.0
    do(hands.world, Act.RELEASE)
    hands.wait(0.5)
    assert np.linalg.norm(hands.body.tool_pose()[:3, 3] - stuck) < 0.05
    hands.follow(path, 0, 0.5)
    assert hands.body.tool_pose()[1, 3] == pytest.approx(0.05, abs=0.001)
