"""The check of scenes asks the planner that the robot uses, amid all that will stand there."""

import json
import re

import numpy as np
import pytest
from sampled import sample

from mend.robots.arm.behaviors.behavior import Situation, Step
from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.behaviors.pick_and_place import PickAndPlace, PickAndPlaceParameters
from mend.robots.arm.behaviors.planning import Plan, at_once, plan_amid
from mend.robots.arm.feasibility.standing import Standing, at_place, starts
from mend.robots.link.messages import Location
from mend.server.behaviors import behavior_parameters
from mend.sim.random_scene import random_scene
from mend.sim.tabletop.adapter import adapter as tabletop
from mend.sim.workcell.adapter import adapter as workcell
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.scene import Place, Pose, Scene, SceneObject
from mend.tasks.scene_file import built_in_scene
from mend.tasks.task_file import check_task_text

SEEN_M = 0.001
"""What the head camera is off by, at most times."""


def scene_with_pillar(x: float, y: float, height_m: float = 0.3) -> Scene:
    def box(at: Pose, size: tuple[float, float, float], green: float) -> SceneObject:
        return SceneObject(color=(0.9, green, 0.0), size=size, pose=at)

    return Scene(
        name="barred",
        objects={
            "part": box(Pose(x=0.5, y=-0.4), (0.03, 0.05, 0.05), 0.0),
            "pillar": box(Pose(x=x, y=y), (0.06, 0.06, height_m), 0.8),
        },
        places={"part": Place(pose=Pose(x=0.5, y=0.05))},
    )


LEAF = BehaviorNode(
    parent=None,
    name="part",
    behavior="pick_and_place",
    parameters={"object": "part", "place": "part"},
)


@pytest.mark.slow(2)
@pytest.mark.parametrize(
    ("at", "where", "to"),
    [
        ((0.575, -0.4), ("objects", "part", "pose"), "part"),
        *sample([], [((0.5, -0.325), ("objects", "part", "pose"), "part")]),
        ((0.575, 0.05), ("places", "part", "pose"), "the place of part"),
    ],
)
def test_a_tall_box_that_the_arm_would_touch_is_told_of(
    at: tuple[float, float], where: tuple[str, ...], to: str
) -> None:
    (found,) = workcell.check_scene(scene_with_pillar(*at), [LEAF])
    assert found.where == where
    assert found.message == f"pillar stands in the arm's way to {to}: move one of them"


@pytest.mark.parametrize(("x", "height_m"), [(0.575, 0.1), (0.64, 0.3)])
def test_a_lower_box_and_one_farther_away_are_not_in_the_way(x: float, height_m: float) -> None:
    assert workcell.check_scene(scene_with_pillar(x, -0.4, height_m), [LEAF]) == []


def test_neighbours_that_scatter_towards_a_part_leave_the_arm_no_room_for_it() -> None:
    """Of eket with nothing taken away before, though each part by itself could stray so far."""
    take = BehaviorNode(
        parent=None,
        name="pink_bar",
        behavior="pick_and_place",
        parameters={"object": "pink_bar", "place": "pink_bar"},
    )
    eket = built_in_scene("eket")
    (found,) = workcell.check_scene(eket, [take])
    assert found.where == ("scatter", "xy")
    told = re.search(r"pink_bar could be taken with (\d+) mm", found.message)
    assert told is not None
    less = eket.scatter.model_copy(update={"xy": 1e-3 * int(told.group(1))})
    assert workcell.check_scene(eket.model_copy(update={"scatter": less}), [take]) == []


def test_a_gripper_that_floats_has_no_arm_that_could_touch_anything() -> None:
    assert tabletop.check_scene(scene_with_pillar(0.575, -0.4), [LEAF]) == []


def drawn(seed: int) -> tuple[Scene, TaskTreeDefinition]:
    made = random_scene(seed, 8, workcell.check_scene)
    text = json.dumps(made.tree)
    task = check_task_text(text, behavior_parameters(), lambda _: made.scene)
    return made.scene, task.definition


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample([4], [3, 4]))
def test_the_arm_has_a_plan_for_every_part_of_an_accepted_scene_as_it_may_be_seen(
    seed: int,
) -> None:
    """In the order of the tree, from a world's own body and chance, with what it sees a bit off."""
    scene, task = drawn(seed)
    assert workcell.check_scene(scene, task.nodes) == []
    world = WorkcellWorld(scene, seed=seed)
    rng = np.random.default_rng(seed)
    standing = starts(scene)
    for leaf in task.nodes:
        if not isinstance(leaf, BehaviorNode) or leaf.object is None or leaf.place is None:
            continue
        start, goal = standing.pop(leaf.object), at_place(scene, leaf.object, leaf.place)
        boxes = [box for each in standing.values() for box in seen(each, rng).boxes]
        found = at_once(plan_amid(errand(seen(start, rng), goal), world.body, scene.table, boxes))
        assert isinstance(found, Plan), (leaf.object, found.reason)
        standing[leaf.object] = goal
    world.close()


def seen(standing: Standing, rng: np.random.Generator) -> Standing:
    """A part about where it stands."""
    pose, off = standing.pose, rng.uniform(-SEEN_M, SEEN_M, 2)
    moved = pose.model_copy(update={"x": pose.x + off[0], "y": pose.y + off[1]})
    return Standing(standing.part, moved, standing.bottom_z, standing.where)


def errand(start: Standing, goal: Standing) -> Errand:
    def lay_out(situation: Situation) -> list[Step]:
        parameters = PickAndPlaceParameters(object=start.name, place="there")
        return list(PickAndPlace().steps(parameters, situation))

    return Errand(lay_out, start.part, location(start), location(goal))


def location(standing: Standing) -> Location:
    pose = standing.pose
    return Location(x=pose.x, y=pose.y, z=standing.bottom_z, yaw=pose.yaw)
