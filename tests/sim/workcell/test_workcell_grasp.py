"""Parts are carried by friction alone and end up where they belong."""

import math

import numpy as np
import pytest
from sampled import sample
from workcell_hands import TABLE_M, Hands, distance_m

from mend.robots.arm.body import ToolPose
from mend.robots.body import Matrix4
from mend.sim.workcell.parts import PartPose
from mend.sim.workcell.physics import to_matrix
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.scene import Pose, Scene, SceneObject

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["leg", "bar", "plate"])
def test_a_part_is_placed_within_3_mm(hands: Hands, name: str) -> None:
    hands.pick(name)
    assert hands.world.held == name
    place = PartPose.upright(0.55, 0.0, TABLE_M, 0.0)
    hands.place(name, place)
    part = hands.world.parts[name].pose()
    assert hands.world.held is None
    assert distance_m(part, place) < 0.003
    assert abs(math.remainder(part.yaw, math.pi)) < math.radians(2.5)
    assert part.tilt_rad < 0.01


@pytest.mark.parametrize(
    ("size", "mass_kg"), [((0.013, 0.013, 0.036), 0.007), ((0.012, 0.012, 0.020), 0.001)]
)
def test_fingers_do_not_sink_into_small_light_parts(
    size: tuple[float, float, float], mass_kg: float
) -> None:
    rng = np.random.default_rng(5)
    pin = SceneObject(color=(0.8, 0.1, 0.1), size=size, mass_kg=mass_kg, pose=Pose(x=0.5, y=-0.3))
    world = WorkcellWorld(Scene(name="one", objects={"pin": pin}, places={}), seed=7)
    hands = Hands(world)
    openings_m = []
    for _ in range(sample(3, 8)):
        yaw = float(rng.uniform(-1.5, 1.5))
        world.parts["pin"].put(PartPose.upright(0.5, -0.3, TABLE_M, yaw))
        # Seen hardly less exactly than a camera does.
        dx, dy, turn = rng.normal(0.0, (0.0005, 0.0005, 0.03))
        hands.pick("pin", PartPose.upright(0.5 + dx, -0.3 + dy, TABLE_M, yaw + turn))
        openings_m.append(hands.body.gripper_opening_m() if world.held == "pin" else 0.0)
        hands.body.open_gripper(0.036)
        hands.settle()
    world.close()
    assert min(openings_m) > 0.8 * pin.size[1]


def test_closing_the_gripper_on_nothing_holds_nothing(hands: Hands) -> None:
    hands.body.close_gripper()
    hands.settle()
    assert hands.world.held is None
    assert hands.body.gripper_opening_m() < 0.002


def test_the_opening_is_the_width_of_what_is_held(hands: Hands) -> None:
    hands.pick("bar")
    assert hands.body.gripper_opening_m() == pytest.approx(0.03, abs=0.001)


def test_an_opened_gripper_drops_the_part(hands: Hands) -> None:
    hands.pick("bar")
    hands.body.open_gripper()
    hands.settle()
    hands.wait(0.3)
    assert hands.world.held is None
    assert hands.world.parts["bar"].pose().position[2] < TABLE_M + 0.02


@pytest.mark.parametrize(
    ("size", "mass_kg"),
    [
        ((0.085, 0.033, 0.167), 0.47),
        ((0.035, 0.026, 0.190), 0.50),
        ((0.012, 0.012, 0.030), 0.003),
    ],
)
def test_fingers_that_have_turned_press_straight_on_what_they_hold(
    size: tuple[float, float, float], mass_kg: float
) -> None:
    part = SceneObject(color=(0.8, 0.1, 0.1), size=size, mass_kg=mass_kg, pose=Pose(x=0.5, y=-0.2))
    world = WorkcellWorld(Scene(name="one", objects={"part": part}, places={}), seed=7)
    hands = Hands(world)
    hands.pick("part")
    held_at = in_tool(hands)
    askew_rad = []
    for yaw in (1.5, -0.4, 1.0):
        hands.follow(hands.plan(ToolPose(0.5, 0.0, TABLE_M + 0.3, yaw)), 0, 0.75)
        askew_rad.append(pressing_askew_rad(hands))
    moved = in_tool(hands)
    world.close()
    assert max(askew_rad) < math.radians(8)
    assert np.linalg.norm(moved[:3, 3] - held_at[:3, 3]) < 0.001
    assert math.acos(min(1.0, (np.trace(held_at[:3, :3].T @ moved[:3, :3]) - 1) / 2)) < 0.01


def in_tool(hands: Hands) -> Matrix4:
    """The pose of the part in the tool frame."""
    part = hands.world.parts["part"].pose()
    pose: Matrix4 = np.linalg.inv(hands.body.tool_pose()) @ to_matrix(
        part.position, part.quaternion
    )
    return pose


def pressing_askew_rad(hands: Hands) -> float:
    """The widest angle between how the fingers close and how they press on the part."""
    closing = hands.body.tool_pose()[:3, 1]
    return max(math.acos(min(1.0, abs(each @ closing))) for each in hands.pressing("part"))


def test_grasping_and_carrying_feels_like_no_contact(hands: Hands) -> None:
    forces = []

    def feel() -> bool:
        forces.append(hands.body.contact_force_n())
        return False

    pose = hands.world.parts["leg"].pose()
    pick = ToolPose(pose.position[0], pose.position[1], TABLE_M + 0.055, pose.yaw)
    path = hands.plan(ToolPose(pick.x, pick.y, pick.z + 0.14, pick.yaw), pick)
    hands.follow(path, 0, 1.0, feel)
    hands.follow(path, 1, 0.5, feel)
    assert max(forces) < 5.0
    hands.body.close_gripper()
    hands.settle()
    assert hands.world.held == "leg"
    hands.follow(hands.plan(ToolPose(pick.x, pick.y, pick.z + 0.1, pick.yaw)), 0, 0.5)
    forces.clear()
    hands.follow(hands.plan(ToolPose(pick.x, pick.y + 0.1, pick.z + 0.1, pick.yaw)), 0, 0.75, feel)
    assert max(forces) < 10.0


def test_the_same_seed_and_motions_give_the_same_world(scene: Scene) -> None:
    poses = []
    for _ in range(2):
        world = WorkcellWorld(scene, seed=3)
        hands = Hands(world)
        hands.pick("bar")
        hands.place("bar", PartPose.upright(0.55, 0.0, TABLE_M, 0.0))
        poses.append([(part.pose(), world.body.time_s()) for part in world.parts.values()])
        world.close()
    assert poses[0] == poses[1]
