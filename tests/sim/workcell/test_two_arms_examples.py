"""What is shipped for two robots can be done by two PR2s."""

from pathlib import Path

import pytest
from sampled import sample

from mend.robots.arm.feasibility.transfers import plan_transfers
from mend.server.behaviors import behavior_parameters
from mend.sim.workcell.adapter import adapter
from mend.tasks.scene_file import built_in_scene, check_scene_file
from mend.tasks.task_file import check_task_text

EXAMPLES = Path(__file__).parents[3] / "examples" / "two_arms"
LIBRARY = Path(__file__).parents[3] / "tasks" / "library"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tree", "scene", "leaves"),
    [
        *sample([], [(LIBRARY / "kit.yaml", "kit_for_two", 20)]),
        (LIBRARY / "tea_table.yaml", "tea_table_for_two", 14),
        (EXAMPLES / "swap.yaml", "across", 4),
    ],
    ids=lambda each: each.stem if isinstance(each, Path) else None,
)
def test_two_pr2s_can_do_a_shipped_task(tree: Path, scene: str, leaves: int) -> None:
    read = check_scene_file(EXAMPLES / f"{scene}.yaml")
    assert adapter.check_scene(read, []) == []
    task = check_task_text(tree.read_text(), behavior_parameters(), built_in_scene)
    planned = plan_transfers(task.definition, read, adapter.reach(read))
    nodes = planned.tree.nodes
    assert sum(each.kind == "behavior" for each in nodes) == leaves
    assert adapter.check_scene(planned.scene, nodes) == []
