"""Task trees written in one line, for tests: `then("a", or_("b", "c"))`."""

from pydantic import BaseModel

from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition
from mend.tasks.task_tree import TaskTree

Written = str | tuple[str, tuple["Written", ...]]


class PickAndPlaceParameters(BaseModel):
    object: str
    place: str
    needs_help: bool = False


BEHAVIORS = {"pick_and_place": PickAndPlaceParameters}


def then(*children: Written) -> Written:
    return ("then", children)


def and_(*children: Written) -> Written:
    return ("and", children)


def or_(*children: Written) -> Written:
    return ("or", children)


def running_tree(written: Written) -> TaskTree:
    """A running tree; leaves are called as written, goal nodes `g{index}`."""
    nodes: list[GoalNode | BehaviorNode] = []

    def add(node: Written, parent: int | None) -> None:
        if isinstance(node, str):
            nodes.append(BehaviorNode(parent=parent, name=node, behavior="wait"))
            return
        kind, children = node
        index = len(nodes)
        fields = {"kind": kind, "parent": parent, "name": f"g{index}"}
        nodes.append(GoalNode.model_validate(fields))
        for child in children:
            add(child, index)

    add(written, None)
    tree = TaskTree(TaskTreeDefinition(name="t", nodes=nodes))
    tree.running = True
    return tree


def node_called(tree: TaskTree, name: str) -> int:
    return next(i for i in range(len(tree)) if tree.name_of(i) == name)


def eligible_names(tree: TaskTree) -> list[str]:
    return [tree.name_of(int(i)) for i in tree.eligible_leaves()]
