"""The shape of a task tree: what never changes while it runs, laid out for fast look-up."""

from collections.abc import Sequence

from tasks.definition import NodeKind, TaskTreeDefinition

NO_NODE = -1
"""Stands for "none" where an index is kept in an array of integers."""


class UnknownNodeError(LookupError):
    """A path leads to no node of the tree; raised by `TreeShape.index_of`."""


class TreeShape:
    """Parents, children and paths. A node is its index; the nodes under it follow it directly.

    The lists are public for the inner loops of this package; nobody may change them.
    """

    def __init__(self, definition: TaskTreeDefinition) -> None:
        size = len(definition.nodes)
        self.kinds: list[NodeKind] = [NodeKind(node.kind) for node in definition.nodes]
        self.parents: list[int] = [NO_NODE] * size
        self.children: list[list[int]] = [[] for _ in range(size)]
        self.positions: list[int] = [0] * size
        for index, node in enumerate(definition.nodes):
            if node.parent is not None:
                siblings = self.children[node.parent]
                self.parents[index] = node.parent
                self.positions[index] = len(siblings)
                siblings.append(index)
        self.ends: list[int] = self._find_ends()
        self.leaves: Sequence[int] = [
            index for index, kind in enumerate(self.kinds) if kind is NodeKind.BEHAVIOR
        ]

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
        """The node at a path. Raises `UnknownNodeError` if there is none."""
        node = 0
        if path == "/":
            return node
        root, *steps = path.split("/")
        if root or not steps:
            raise UnknownNodeError(f"'{path}' is not a node path; one looks like /0/2 or /")
        for step in steps:
            siblings = self.children[node]
            if not (step.isascii() and step.isdigit() and str(int(step)) == step):
                raise UnknownNodeError(f"'{path}' is not a node path: '{step}' is not a number")
            if int(step) >= len(siblings):
                raise UnknownNodeError(
                    f"no node at '{path}': '{self.path_of(node)}' has {len(siblings)} children"
                )
            node = siblings[int(step)]
        return node

    def _find_ends(self) -> list[int]:
        """For every node, the index after the last node under it."""
        ends = list(range(1, len(self) + 1))
        for node in range(len(self) - 1, 0, -1):
            parent = self.parents[node]
            ends[parent] = max(ends[parent], ends[node])
        return ends
