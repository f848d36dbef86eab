"""What a workcell shows to people: where everything really is, joints, and the model to draw."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from workcell_hands import Hands, do

from mend.robots.arm.shown_arm import JointedBody
from mend.robots.link.messages import ShownPose
from mend.server.models.robot_models import WorldModels
from mend.sim.workcell.adapter import adapter
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.intervention import Act


def shown(world: WorkcellWorld, name: str) -> ShownPose:
    names = [each.name for each in world.shown_objects]
    return world.shown_poses()[names.index(name)]


def test_parts_are_shown_where_they_are(world: WorkcellWorld) -> None:
    for name, part in world.parts.items():
        assert shown(world, name).pose[:3] == pytest.approx(part.pose().position)
        assert shown(world, name).pose[3:] == pytest.approx(part.pose().quaternion)


def test_what_is_stolen_is_gone(world: WorkcellWorld) -> None:
    assert do(world, Act.STEAL, "bar") == ""
    assert shown(world, "bar").gone
    assert do(world, Act.PUT_BACK, "bar") == ""
    assert not shown(world, "bar").gone


@pytest.mark.slow
def test_what_the_fingers_hold_is_held(world: WorkcellWorld, hands: Hands) -> None:
    assert not shown(world, "bar").held
    hands.pick("bar")
    assert shown(world, "bar").held


def test_the_obstacle_is_shown_while_somebody_holds_it(world: WorkcellWorld) -> None:
    assert shown(world, "obstacle").gone
    assert do(world, Act.BLOCK) == ""
    assert not shown(world, "obstacle").gone


def test_the_joints_are_those_that_move_in_the_model(world: WorkcellWorld) -> None:
    body = world.body
    assert isinstance(body, JointedBody)
    urdf = ElementTree.parse(adapter.model_folder() / "robot.urdf").getroot()
    moving = {each.get("name") for each in urdf.findall("joint") if each.get("type") != "fixed"}
    assert set(body.joint_names) == moving
    assert np.all(np.isfinite(body.joint_positions()))
    assert len(body.joint_positions()) == len(body.joint_names)


def test_every_mesh_that_is_drawn_is_served_and_lean() -> None:
    models = WorldModels([adapter])
    assert models.address(adapter.model) == "/api/models/pr2/robot.urdf"
    urdf = ElementTree.parse(models.file("pr2", "robot.urdf")).getroot()
    meshes = {
        mesh.get("filename", "")
        for link in urdf.findall("link")
        for visual in link.findall("visual")
        for mesh in visual.iter("mesh")
    }
    sizes = [models.file("pr2", each).stat().st_size for each in meshes]
    assert len(meshes) == 14
    assert sum(sizes) < 1_000_000
    assert all(each.endswith(".stl") for each in meshes)
