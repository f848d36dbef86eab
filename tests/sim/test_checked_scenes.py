"""That a scene and its leaves are checked once, however often somebody asks."""

from collections.abc import Sequence

import pytest
from two_boxes import BENCH, BOTH

from mend.server.behaviors import behavior_parameters
from mend.sim.checked_scenes import checked_scene
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene import Scene
from mend.tasks.scene_file import check_scene_text
from mend.tasks.scene_problem import SceneProblem
from mend.tasks.task_file import check_task_text

FOUND = SceneProblem(("objects", "red_box"), "it is too far away")


class Checker:
    """Finds the same in each scene, and counts how often it looks."""

    def __init__(self) -> None:
        self.checks = 0

    def check_scene(
        self,
        scene: Scene,  # noqa: ARG002
        nodes: Sequence[GoalNode | BehaviorNode],  # noqa: ARG002
    ) -> list[SceneProblem]:
        self.checks += 1
        return [FOUND]


CHECKER = Checker()
MAKER = (__name__, "CHECKER")


@pytest.fixture
def checker() -> Checker:
    CHECKER.checks = 0
    return CHECKER


def bench(name: str) -> Scene:
    return check_scene_text(BENCH).model_copy(update={"name": name})


def leaves(scene: Scene) -> list[GoalNode | BehaviorNode]:
    read = check_task_text(BOTH, behavior_parameters(), lambda _: scene)
    return list(read.definition.nodes)


def test_what_reads_the_same_is_checked_once(checker: Checker) -> None:
    for _ in range(3):
        scene = bench("asked_again")
        assert checked_scene(MAKER, scene, leaves(scene)) == [FOUND]
    assert checker.checks == 1


def test_another_scene_or_other_leaves_are_checked_anew(checker: Checker) -> None:
    scene = bench("asked_otherwise")
    red, *_ = scene.objects.values()
    moved = red.model_copy(update={"mass_kg": red.mass_kg + 0.1})
    heavier = scene.model_copy(update={"objects": {**scene.objects, "red_box": moved}})
    for each in (scene, heavier):
        for nodes in (leaves(scene), leaves(scene)[:1], []):
            checked_scene(MAKER, each, nodes)
    assert checker.checks == 6


def test_who_changes_what_was_found_changes_it_for_nobody_else(checker: Checker) -> None:
    scene = bench("changed_afterwards")
    checked_scene(MAKER, scene, []).clear()
    assert checked_scene(MAKER, scene, []) == [FOUND]
    assert checker.checks == 1
