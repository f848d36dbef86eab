"""What stands in the arm's way is found out before the run, with the arm's own planner."""

from collections.abc import Sequence

import pytest

from sim.tabletop.adapter import adapter as tabletop
from sim.workcell.adapter import adapter as workcell
from tasks.definition import BehaviorNode, GoalNode
from tasks.scene import Place, Pose, Scene, SceneObject
from tasks.scene_problem import SceneProblem


def beside(apart_m: float, height_m: float) -> Scene:
    """A small part, with something 60 mm wide so far beside it."""
    tall = SceneObject(
        color=(0.9, 0.1, 0.1), size=(0.06, 0.06, height_m), pose=Pose(x=0.60, y=-0.30 + apart_m)
    )
    small = SceneObject(color=(0.1, 0.1, 0.9), size=(0.04, 0.04, 0.05), pose=Pose(x=0.60, y=-0.3))
    places = {"small": Place(pose=Pose(x=0.6, y=0.1)), "tall": Place(pose=Pose(x=0.5, y=-0.1))}
    return Scene(name="beside", objects={"tall": tall, "small": small}, places=places)


def problems(scene: Scene, *names: str) -> Sequence[SceneProblem]:
    leaves = [
        BehaviorNode(
            parent=0,
            name=name,
            behavior="pick_and_place",
            parameters={"object": name, "place": name},
        )
        for name in names
    ]
    return workcell.check_scene(scene, [GoalNode(kind="then", parent=None, name="all"), *leaves])


def test_something_tall_beside_a_part_that_bars_the_arm_is_told_before_the_run() -> None:
    [problem] = problems(beside(0.075, 0.30), "small")
    assert problem.where == ("objects", "small", "pose")
    assert problem.message.startswith("with small the arm would touch tall on its way")


@pytest.mark.parametrize(("apart_m", "height_m"), [(0.075, 0.06), (0.22, 0.30)])
def test_what_is_low_or_far_away_bars_nothing(apart_m: float, height_m: float) -> None:
    assert problems(beside(apart_m, height_m), "small") == []


def test_a_gripper_that_floats_has_no_arm_that_anything_could_bar() -> None:
    leaf = BehaviorNode(
        parent=None,
        name="small",
        behavior="pick_and_place",
        parameters={"object": "small", "place": "small"},
    )
    assert tabletop.check_scene(beside(0.075, 0.30), [leaf]) == []
