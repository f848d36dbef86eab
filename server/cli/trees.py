"""`mend trees`: the task trees that come with Mend."""

from mend.server.cli.failures import told_plainly
from mend.server.cli.rows import print_rows


def trees() -> None:
    """List the task trees that come with Mend: their leaves, scene and purpose."""
    from mend.server.behaviors import behavior_parameters
    from mend.tasks.definition import BehaviorNode
    from mend.tasks.library import TREES
    from mend.tasks.task_file import check_built_in_task

    with told_plainly():
        behaviors = behavior_parameters()
        tasks = [check_built_in_task(name, behaviors).definition for name in TREES.names()]
    rows: list[tuple[str, ...]] = []
    for each in tasks:
        leaves = sum(isinstance(node, BehaviorNode) for node in each.nodes)
        purpose = " ".join(each.description.split())
        rows.append((each.name, str(leaves), each.scene or "any", purpose))
    print_rows(rows, ("tree", "leaves", "scene", "what is built"))
