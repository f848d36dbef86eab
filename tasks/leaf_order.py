"""In which order the leaves of a tree are done, and which of them exclude each other."""

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from functools import cached_property

from mend.tasks.definition import BehaviorNode, GoalNode


class LeafOrder:
    """Of a whole tree in its depth-first list of nodes, or of leaves alone, which all are done."""

    def __init__(self, nodes: Sequence[GoalNode | BehaviorNode]) -> None:
        self._nodes = nodes
        self._whole = bool(nodes) and isinstance(nodes[0], GoalNode)

    @property
    def leaves(self) -> list[tuple[int, BehaviorNode]]:
        """Every leaf with its index among the nodes."""
        return [(index, node) for index, node in enumerate(self._nodes) if node.kind == "behavior"]

    def exclusive(self, first: int, second: int) -> bool:
        """Whether an OR has at most one of two leaves done."""
        return self._fork(first, second)[0] == "or"

    def is_before(self, first: int, second: int, *, surely: bool = True) -> bool:
        """Whether the first leaf is done before the second one starts.

        `surely`: also if no OR may leave the first one undone.
        """
        kind, one, two = self._fork(first, second)
        if kind != "then" or one[-1] > two[-1]:
            return False
        if not surely:
            return True
        parents = (self._nodes[each].parent for each in one[:-1])
        return not any(
            parent is not None and self._nodes[parent].kind == "or" for parent in parents
        )

    def others_do(self, first: int, second: int, leaves: AbstractSet[int]) -> bool:
        """Whether each alternative to the first leaf has one of `leaves` done for the second one.

        An alternative is what an OR above the first leaf, and not above the second, may have done
        in its stead.
        """
        way = self._fork(first, second)[1]
        return all(
            self._has_done(child, leaves)
            for node in way[:-1]
            if (parent := self._nodes[node].parent) is not None and self._nodes[parent].kind == "or"
            for child in self._children[parent]
            if child != node
        )

    def _has_done(self, node: int, leaves: AbstractSet[int]) -> bool:
        """Whether one of some leaves is done whenever a node is."""
        under = (self._has_done(child, leaves) for child in self._children[node])
        match self._nodes[node].kind:
            case "behavior":
                return node in leaves
            case "or":
                return all(under)
            case _:
                return any(under)

    @cached_property
    def _children(self) -> list[list[int]]:
        children: list[list[int]] = [[] for _ in self._nodes]
        for index, node in enumerate(self._nodes):
            if node.parent is not None:
                children[node.parent].append(index)
        return children

    def _fork(self, first: int, second: int) -> tuple[str, list[int], list[int]]:
        """The kind of the lowest node over both, and the ways up to below it from each."""
        if not self._whole or first == second:
            return "and", [first], [second]
        one, two = self._way_up(first), self._way_up(second)
        while one[-1] == two[-1]:
            above = one.pop()
            two.pop()
        return self._nodes[above].kind, one, two

    def _way_up(self, node: int) -> list[int]:
        way = [node]
        while (parent := self._nodes[way[-1]].parent) is not None:
            way.append(parent)
        return way
