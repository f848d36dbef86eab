"""The task tree as a run left it: the run's events folded into its tree, and each node's fate."""

from collections import Counter

from mend.server.journal import events as ev
from mend.server.report.record import RunRecord
from mend.server.report.tree_drawing import NodeFate, NodeState
from mend.server.transcript_words import as_said
from mend.tasks.definition import NodeKind, TaskTreeDefinition
from mend.tasks.task_tree import TaskTree

DOERS: dict[ev.DoneBy, str] = {
    "robot": "by the robot",
    "human": "by the human",
    "both": "by robot and human",
    "found": "found in place",
}


def node_states(record: RunRecord) -> list[NodeState]:
    """Every node, parents first."""
    tree = _folded(record)
    starts = Counter(each.started.node for each in record.executions)
    return [_node_state(tree, node, record, starts) for node in range(len(tree))]


def _folded(record: RunRecord) -> TaskTree:
    tree = TaskTree(TaskTreeDefinition.model_validate(record.started.tree))
    tree.running = True
    for event in record.events:
        match event:
            case ev.NodeStarted():
                tree.start(tree.index_of(event.node), event.robot)
            case ev.NodeTaken():
                tree.start(tree.index_of(event.node), event.helper)
            case ev.NodeLeftOut(robot=None):
                tree.start(tree.index_of(event.node), event.helper)
                tree.finish(tree.index_of(event.node))
            case ev.NodeDone() | ev.NodeLeftOut():
                tree.finish(tree.index_of(event.node))
            case ev.LeafTriedAgain():
                tree.try_again(tree.index_of(event.node))
            case ev.NodeUndone():
                tree.take_back(tree.index_of(event.node))
            case ev.NodeReset():
                tree.put_back(tree.index_of(event.node), failed=event.failed_attempt)
            case ev.NodeAbandoned():
                tree.abandon(tree.index_of(event.node))
    return tree


def _node_state(tree: TaskTree, node: int, record: RunRecord, starts: Counter[str]) -> NodeState:
    path, leaf = tree.path_of(node), tree.kind_of(node) is NodeKind.BEHAVIOR
    return NodeState(
        path=path,
        kind=tree.kind_of(node).value,
        name=tree.name_of(node),
        object=tree.leaf_definition(node).object if leaf else None,
        fate=_fate(tree, node, starts[path]),
        detail=_detail(tree, node, record, starts[path]) if leaf else "",
    )


def _fate(tree: TaskTree, node: int, starts: int) -> NodeFate:
    if tree.done(node):
        return "done"
    if tree.abandoned(node):
        return "abandoned"
    if tree.active(node):
        return "active"
    return "tried" if starts else "untouched"


def _detail(tree: TaskTree, leaf: int, record: RunRecord, starts: int) -> str:
    parts = []
    path = tree.path_of(leaf)
    if (done := record.done.get(path)) is not None:
        parts.append(DOERS[done.by])
    if (left_out := record.left_out.get(path)) is not None:
        parts.append(f"left out, {as_said(left_out.helper)}")
    if undone := sum(each.node == path for each in record.undone):
        parts.append("undone once" if undone == 1 else f"undone {undone} times")
    if starts > 1:
        parts.append(f"{starts} starts")
    if failed := tree.attempts(leaf):
        parts.append(f"{failed} failed")
    return ", ".join(parts)
