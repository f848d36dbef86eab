"""Alternatives that are the same: of those of one OR that do the same, one tells all there is."""

from collections.abc import Sequence
from dataclasses import dataclass

from mend.tasks.definition import BehaviorNode, GoalNode

Nodes = Sequence[GoalNode | BehaviorNode]

MOST_COMPARED_LEAVES = 400
"""Of so many leaves each is compared with each; repeated alternatives do not count."""


@dataclass(frozen=True, slots=True)
class DistinctNodes:
    """A tree without repeated alternatives; `originals` has each node's index in the whole one."""

    nodes: Nodes
    originals: Sequence[int]


def distinct_alternatives(nodes: Nodes) -> DistinctNodes:
    """Leave out every alternative of an OR that does what an earlier one of that OR does.

    What is before or after an alternative, and what excludes it, is the same for both. `nodes` are
    a whole tree, depth first, or leaves alone.
    """
    if not nodes or isinstance(nodes[0], BehaviorNode):
        return DistinctNodes(nodes, range(len(nodes)))
    repeated = _repeated(nodes)
    kept: list[GoalNode | BehaviorNode] = []
    originals: list[int] = []
    moved_to: dict[int, int] = {}
    for index, node in enumerate(nodes):
        if repeated[index] or (node.parent is not None and node.parent not in moved_to):
            continue
        moved_to[index] = len(kept)
        originals.append(index)
        parent = None if node.parent is None else moved_to[node.parent]
        kept.append(node if parent == node.parent else node.model_copy(update={"parent": parent}))
    return DistinctNodes(kept, originals)


def _repeated(nodes: Nodes) -> bytearray:
    """Which nodes are alternatives that do what an earlier one of the same OR does."""
    repeated = bytearray(len(nodes))
    children: list[list[int]] = [[] for _ in nodes]
    for index, node in enumerate(nodes):
        if node.parent is not None:
            children[node.parent].append(index)
    numbers: dict[object, int] = {}
    deeds = [0] * len(nodes)
    for index in range(len(nodes) - 1, -1, -1):
        node = nodes[index]
        under = [deeds[child] for child in children[index]]
        if node.kind == "or":
            seen: set[int] = set()
            for child, deed in zip(children[index], under, strict=True):
                repeated[child] = deed in seen
                seen.add(deed)
        key = (
            (node.behavior, node.object, node.place)
            if isinstance(node, BehaviorNode)
            else (node.kind, *under)
        )
        deeds[index] = numbers.setdefault(key, len(numbers))
    return repeated
