"""What a world of arms cannot do at all: scenes without objects, behaviors of other bodies."""

from collections.abc import Sequence

from mend.documents.problem import list_names
from mend.robots.arm.behaviors.behavior import ArmBehavior
from mend.robots.execution.behavior import of_kind
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem


def not_for_arms(scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]) -> list[SceneProblem]:
    """Why no arm has anything to do in a scene, or cannot do behaviors among `nodes`.

    Each behavior is told of once, at the first place that it names.
    """
    can = of_kind(load_plugins("mend.behaviors"), ArmBehavior)  # type: ignore[type-abstract]
    others: dict[str, BehaviorNode] = {}
    for node in nodes:
        if isinstance(node, BehaviorNode) and node.behavior not in can:
            others.setdefault(node.behavior, node)
    if not others and not scene.objects:
        return [SceneProblem(("objects",), "an arm needs at least one object to take hold of")]
    return [
        SceneProblem(
            () if node.place is None else ("places", node.place),
            f"no arm can do '{name}'; what the robots of this world can do is {list_names(can)}",
        )
        for name, node in others.items()
    ]
