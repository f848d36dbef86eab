"""A world rebuilt from a snapshot is as it was, but for what was in the air."""

import json

import numpy as np
import pytest
from workcell_hands import Hands, distance_m, do

from mend.sim.workcell.robot_model import NEUTRAL_RAD
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.intervention import Act
from mend.tasks.scene import Pose, Scene


def rebuild(world: WorkcellWorld, scene: Scene) -> WorkcellWorld:
    """Another world, of another seed, rebuilt from a snapshot that went through JSON."""
    other = WorkcellWorld(scene, seed=99)
    other.restore(json.loads(json.dumps(world.snapshot())))
    return other


def test_parts_and_clock_come_back(hands: Hands, scene: Scene) -> None:
    do(hands.world, Act.MOVE, "bar", to=Pose(x=0.5, y=0.1, yaw=1.0))
    do(hands.world, Act.STEAL, "leg")
    hands.wait(0.4)
    other = rebuild(hands.world, scene)
    assert other.body.time_s() == hands.body.time_s()
    for name in ("bar", "plate"):
        assert distance_m(other.parts[name].pose(), hands.world.parts[name].pose()) < 5e-4
    assert other.parts["bar"].pose().yaw == pytest.approx(1.0, abs=0.01)
    assert other.parts["leg"].stolen
    assert do(other, Act.PUT_BACK, "leg") == ""
    assert distance_m(other.parts["leg"].pose(), hands.world.parts["leg"].start) < 0.002
    other.close()


def test_what_is_held_lies_where_it_last_rested_and_the_arm_is_at_neutral(
    hands: Hands, scene: Scene
) -> None:
    start = hands.world.parts["bar"].pose()
    hands.pick("bar")
    assert hands.world.snapshot()["held"] == "bar"
    other = rebuild(hands.world, scene)
    assert other.held is None
    assert distance_m(other.parts["bar"].pose(), start) < 0.001
    joints = other.body.pr2.arm_joints()
    assert np.allclose(joints, NEUTRAL_RAD, atol=2e-3)
    Hands(other).pick("bar")
    assert other.held == "bar"
    other.close()


def test_who_blocks_and_who_hands_over_goes_on(hands: Hands, scene: Scene) -> None:
    do(hands.world, Act.BLOCK)
    do(hands.world, Act.HAND_OVER, "bar")
    other = rebuild(hands.world, scene)
    assert do(other, Act.BLOCK) == "somebody stands in the way already"
    assert do(other, Act.HAND_OVER, "leg") == "somebody is handing over 'bar' already"
    other.close()


def test_two_worlds_from_one_snapshot_go_on_alike(hands: Hands, scene: Scene) -> None:
    hands.pick("bar")
    poses = []
    for _ in range(2):
        other = rebuild(hands.world, scene)
        again = Hands(other)
        again.pick("leg")
        poses.append([part.pose() for part in other.parts.values()])
        other.close()
    assert poses[0] == poses[1]


def test_taking_a_snapshot_changes_nothing(hands: Hands) -> None:
    assert hands.world.snapshot() == hands.world.snapshot()


def test_a_snapshot_of_another_scene_is_refused(world: WorkcellWorld, scene: Scene) -> None:
    fewer = scene.model_copy(update={"objects": {"leg": scene.objects["leg"]}})
    other = WorkcellWorld(fewer, seed=0)
    with pytest.raises(ValueError, match=r"snapshot has the parts .*, the scene \['leg'\]"):
        other.restore(world.snapshot())
    other.close()
