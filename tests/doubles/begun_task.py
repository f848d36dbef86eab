"""Shipped tasks that are done for the most part: long ones for short tests."""

import random
from collections import Counter

from mend.server.behaviors import behavior_parameters
from mend.tasks.definition import BehaviorNode
from mend.tasks.scenario import Scenario
from mend.tasks.scene import Pose, Scatter, Scene
from mend.tasks.task_file import check_built_in_task


def begun(task: str, left: int, seed: int) -> Scene:
    """The scene of a shipped task, in which the parts of all but `left` leaves are at their places.

    Which leaves, says the seed; where something is put onto something, they are the first ones.
    Nothing is at a place that several leaves may fill. Parts at their places lie exactly there,
    the others are scattered as the scene says.
    """
    checked = check_built_in_task(task, behavior_parameters())
    scene = checked.scene
    assert scene is not None
    leaves = [each for each in checked.definition.nodes if isinstance(each, BehaviorNode)]
    fill = Counter(each.place for each in leaves)
    alone = [each for each in leaves if fill[each.place] == 1]
    done = len(leaves) - left
    chance = random.Random(seed)
    stacked = any(place.pose.z is not None for place in scene.places.values())
    there = {
        leaf.object: scene.places[leaf.place].pose
        for leaf in (alone[:done] if stacked else chance.sample(alone, done))
        if leaf.object is not None and leaf.place is not None
    }
    objects = {
        name: part.model_copy(
            update={"pose": there.get(name) or _scattered(part.pose, scene.scatter, chance)}
        )
        for name, part in scene.objects.items()
    }
    return scene.model_copy(update={"objects": objects, "scatter": Scatter()})


def placed(task: str, left: int) -> Scenario:
    """People who place the parts of the first leaves at once, and leave `left` to do.

    For what no scene can begin with: parts that stand on others.
    """
    definition = check_built_in_task(task, behavior_parameters()).definition
    leaves = [each for each in definition.nodes if isinstance(each, BehaviorNode)]
    placing = [
        {"at_s": 0.0, "do": {"act": "place", "object": each.object, "place": each.place}}
        for each in leaves[: len(leaves) - left]
    ]
    return Scenario.model_validate(
        {"name": "placed", "tree": task, "interventions": placing}, strict=False
    )


def _scattered(pose: Pose, scatter: Scatter, chance: random.Random) -> Pose:
    return pose.model_copy(
        update={
            "x": pose.x + chance.uniform(-scatter.xy, scatter.xy),
            "y": pose.y + chance.uniform(-scatter.xy, scatter.xy),
            "yaw": pose.yaw + chance.uniform(-scatter.yaw, scatter.yaw),
        }
    )
