"""Where the ways from the root of a tree to several leaves part."""

import numpy as np
from numpy.typing import NDArray

from mend.tasks.definition import NodeKind
from mend.tasks.task_tree import TaskTree


class Parting:
    """Where the ways from the root to other leaves and to a certain one part.

    `height`: how many nodes above that leaf; `at_or`: whether at an OR, so that the leaves lie
    under different alternatives. Two others that part from it at different heights part from each
    other at the upper one.
    """

    def __init__(self, tree: TaskTree, leaf: int, others: NDArray[np.int64]) -> None:
        self.height = np.zeros(others.size, dtype=np.int64)
        self.at_or = np.zeros(others.size, dtype=np.bool_)
        way = [leaf, *ancestors(tree, leaf)]
        begins = others.searchsorted(way)
        ends = others.searchsorted([tree.end_of(node) for node in way])
        # Where no other leaf is added to those under a node, none parts from it there.
        for height in (np.flatnonzero((np.diff(begins) != 0) | (np.diff(ends) != 0)) + 1).tolist():
            for part in (
                slice(begins[height], begins[height - 1]),
                slice(ends[height - 1], ends[height]),
            ):
                self.height[part] = height
                self.at_or[part] = tree.kind_of(way[height]) is NodeKind.OR


def ancestors(tree: TaskTree, node: int) -> list[int]:
    """The nodes on the way from a node's parent to the root."""
    found: list[int] = []
    above = tree.parent_of(node)
    while above is not None:
        found.append(above)
        above = tree.parent_of(above)
    return found
