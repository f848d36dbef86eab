"""`mend trees`: the task trees that come with Mend."""

from mend.server.behaviors import behavior_parameters
from mend.server.cli.failures import told_plainly
from mend.server.cli.output import print_rows
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.library import TREES
from mend.tasks.task_file import check_built_in_task


def trees() -> None:
    """List the task trees that come with Mend: their leaves, scene and purpose."""
    with told_plainly():
        behaviors = behavior_parameters()
        tasks = [check_built_in_task(name, behaviors).definition for name in TREES.names()]
    print_rows([_row(each) for each in tasks], ("tree", "leaves", "scene", "what is built"))


def _row(task: TaskTreeDefinition) -> tuple[str, ...]:
    leaves = sum(isinstance(node, BehaviorNode) for node in task.nodes)
    return task.name, str(leaves), task.scene or "any", " ".join(task.description.split())
