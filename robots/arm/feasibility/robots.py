"""The check of a scene with several robots: what one of them can do is no problem."""

from collections import Counter
from collections.abc import Callable, Sequence

from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.frames import frames_of
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem


def check_for_each_robot(
    scene: Scene,
    nodes: Sequence[GoalNode | BehaviorNode],
    check: Callable[[Scene], list[SceneProblem]],
) -> list[SceneProblem]:
    """The problems that every robot has; `check` looks at a scene in a robot's own frame.

    Of a leaf whose object one robot cannot take and whose place no other can fill, the problems of
    the first are told.
    """
    found = [check(frame.scene_to_robot(scene)) for frame in frames_of(scene).values()]
    first, *others = found
    theirs = [{problem.where for problem in each} for each in others]
    told = [problem for problem in first if all(problem.where in each for each in theirs)]
    leaves = [node for node in nodes if isinstance(node, BehaviorNode)]
    handled = Counter(leaf.object for leaf in leaves)
    for leaf in leaves:
        # What several leaves handle, one takes where another has put it.
        if handled[leaf.object] == 1 and not any(_about(leaf, told)):
            problems = [_about(leaf, each) for each in found]
            if all(problems):
                told += problems[0]
    return told


def _about(leaf: BehaviorNode, problems: Sequence[SceneProblem]) -> list[SceneProblem]:
    """The problems that concern a leaf's object or its place."""
    ends = {("objects", leaf.object), ("places", leaf.place)}
    return [problem for problem in problems if problem.where[:2] in ends]
