"""The shape of a task tree: what never changes while it runs, laid out for fast look-up."""

from array import array
from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mend.errors import NotFoundError
from mend.tasks.definition import NodeKind

NO_NODE = -1
"""Stands for "none" where an index is kept in an array of integers."""

THEN_CODE, AND_CODE, OR_CODE, LEAF_CODE = range(4)
_CODES = {
    NodeKind.THEN: THEN_CODE,
    NodeKind.AND: AND_CODE,
    NodeKind.OR: OR_CODE,
    NodeKind.BEHAVIOR: LEAF_CODE,
}


class TreeShape:
    """Parents, children and paths. A node is its index; the nodes under it follow it directly.

    Nodes are added one by one, depth first, so that a large tree can be laid out in pieces; after
    `close` nothing changes any more. The lists are public for the inner loops of this package;
    nobody may change them.
    """

    def __init__(self) -> None:
        self.kinds: list[NodeKind] = []
        self.kind_codes = bytearray()
        self.parents = array("q")
        self.children: list[Sequence[int]] = []
        self.positions = array("q")
        self.ends = array("q")
        """For every node, the index after the last node under it."""
        self.leaves = array("q")
        self._open: list[int] = []

    def add(self, kind: NodeKind, parent: int | None) -> int:
        """Add the next node, depth first; returns its index. Raises `ValueError`: out of order."""
        node = len(self.kinds)
        position = 0
        if parent is None:
            if node > 0:
                raise ValueError(f"node {node} has no parent, but only node 0 is the root")
        else:
            position = self._begin_child(node, parent)
        self.kinds.append(kind)
        self.kind_codes.append(_CODES[kind])
        self.parents.append(NO_NODE if parent is None else parent)
        self.positions.append(position)
        self.ends.append(node + 1)
        if kind is NodeKind.BEHAVIOR:
            self.leaves.append(node)
            self.children.append(())
        else:
            self._open.append(node)
            self.children.append([])
        return node

    def _begin_child(self, node: int, parent: int) -> int:
        """Close the goal nodes that have no more children; returns the child's position."""
        while self._open and self._open[-1] != parent:
            self._close_goal(self._open.pop(), node)
        if not self._open:
            raise ValueError(
                f"node {node} must follow its parent in depth-first order, but its parent is "
                f"{parent}"
            )
        siblings = self.children[parent]
        assert isinstance(siblings, list), "an open node is a goal node"
        siblings.append(node)
        return len(siblings) - 1

    def _close_goal(self, goal: int, end: int) -> None:
        if end == goal + 1:
            raise ValueError(f"goal node {goal} must have a child")
        self.ends[goal] = end
        # Whoever collects garbage does not look through tuples of numbers, as it does lists.
        self.children[goal] = tuple(self.children[goal])

    def close(self) -> None:
        """There are no more nodes. Raises `ValueError`: a goal node has no child."""
        if not self.kinds:
            raise ValueError("a task tree has at least one node")
        while self._open:
            self._close_goal(self._open.pop(), len(self))

    def __len__(self) -> int:
        return len(self.kinds)

    def path_of(self, node: int) -> str:
        """The path of child indices from the root: `/` for the root, else `/0/2/1`."""
        steps: list[str] = []
        while node != 0:
            steps.append(str(self.positions[node]))
            node = self.parents[node]
        return "/" + "/".join(reversed(steps))

    def index_of(self, path: str) -> int:
        """The node at a path. Raises `NotFoundError` if there is none."""
        node = 0
        if path == "/":
            return node
        root, *steps = path.split("/")
        if root or not steps:
            raise NotFoundError(f"'{path}' is not a node path; one looks like /0/2 or /")
        for step in steps:
            siblings = self.children[node]
            if not (step.isascii() and step.isdigit() and str(int(step)) == step):
                raise NotFoundError(f"'{path}' is not a node path: '{step}' is not a number")
            if int(step) >= len(siblings):
                raise NotFoundError(
                    f"no node at '{path}': '{self.path_of(node)}' has {len(siblings)} children"
                )
            node = siblings[int(step)]
        return node

    # For many nodes at a time

    @cached_property
    def codes(self) -> NDArray[np.uint8]:
        """The kind of every node."""
        return np.frombuffer(self.kind_codes, dtype=np.uint8)

    @cached_property
    def family(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """All children, those of one node side by side, and where each node's begin among them."""
        parents = np.frombuffer(self.parents, dtype=np.int64)[1:]
        counts = np.bincount(parents, minlength=len(self))
        starts = np.concatenate((np.zeros(1, dtype=np.int64), np.cumsum(counts)))
        return np.argsort(parents, kind="stable") + 1, starts

    def children_of_all(self, goals: NDArray[np.int64]) -> NDArray[np.int64]:
        """The children of several goal nodes, one node's after the other's."""
        children, starts = self.family
        counts = starts[goals + 1] - starts[goals]
        before = np.cumsum(counts) - counts
        at: NDArray[np.int64] = np.arange(counts.sum()) + np.repeat(starts[goals] - before, counts)
        return children[at]
