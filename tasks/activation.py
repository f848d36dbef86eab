"""Activation levels and potentials of a whole tree, or of one node, computed when read.

The rules are those of the design's table, after Blankenburg et al. 2020, Section 3.1.
"""

import math
from array import array
from collections.abc import Iterator, Sequence

from mend.tasks.definition import NodeKind
from mend.tasks.tree_shape import NO_NODE, TreeShape
from mend.tasks.tree_state import LeafStatus, TreeState

_SMALLEST_LEVEL = math.ulp(0.0)
"""Shares of shares may be too small for a float; they must not become 0 all the same."""


def level_of(shape: TreeShape, state: TreeState, node: int) -> float:
    """The activation level of one node of a running tree; work is that of the path to the root."""
    if state.done[node]:
        return 0.0
    shares: list[int] = []
    while node != 0:
        if not state.open_to(node):
            return 0.0
        node = shape.parents[node]
        if shape.kinds[node] is NodeKind.AND:
            shares.append(len(shape.children[node]) - state.done_children[node])
    level = 1.0
    for share in reversed(shares):
        level = _share(level, share)
    return level


PIECE = 1000
"""So many nodes of a tree are evaluated at a time."""


class FullEvaluation:
    """Level and potential of every node, evaluated in pieces.

    `state` must not change meanwhile. `leaf_potentials` has those of the leaves, by node. What is
    done or abandoned has the potential 0.
    """

    def __init__(
        self,
        shape: TreeShape,
        state: TreeState,
        leaf_potentials: Sequence[float],
        *,
        running: bool,
    ) -> None:
        self.levels = array("d", [0.0]) * len(shape)
        self.potentials = array("d", [0.0]) * len(shape)
        self._shape = shape
        self._state = state
        self._running = running
        self._leaf_potentials = leaf_potentials
        self._startable = bytearray(len(shape))

    def pieces(self) -> Iterator[None]:
        """Evaluate the next nodes each time; complete at its end."""
        size = len(self._shape)
        if self._running:
            self.levels[0] = 0.0 if self._state.done[0] else 1.0
            for begin in range(1, size, PIECE):
                self._pass_down(range(begin, min(begin + PIECE, size)))
                yield
        for end in range(size, 0, -PIECE):
            self._pass_up(range(end - 1, max(end - PIECE, 0) - 1, -1))
            yield

    def _pass_down(self, nodes: range) -> None:
        shape, state, levels = self._shape, self._state, self.levels
        for node in nodes:
            parent = shape.parents[node]
            if levels[parent] > 0.0 and not state.done[node] and state.open_to(node):
                levels[node] = levels[parent]
                if shape.kinds[parent] is NodeKind.AND:
                    open_children = len(shape.children[parent]) - state.done_children[parent]
                    levels[node] = _share(levels[parent], open_children)

    def _pass_up(self, nodes: range) -> None:
        shape, state = self._shape, self._state
        for node in nodes:
            if state.done[node] or state.abandoned[node]:
                continue
            if shape.kinds[node] is NodeKind.BEHAVIOR:
                self.potentials[node] = self._leaf_potentials[node]
                self._startable[node] = state.leaf_status[node] is LeafStatus.IDLE
            parent = shape.parents[node]
            if parent != NO_NODE and self._counts_for(parent, node):
                self.potentials[parent] = max(self.potentials[parent], self.potentials[node])
                self._startable[parent] |= self._startable[node]

    def _counts_for(self, parent: int, child: int) -> bool:
        """Whether the potential of a child that is neither done nor abandoned is passed up."""
        shape, state = self._shape, self._state
        if state.done[parent] or state.abandoned[parent] or not state.open_to(child):
            return False
        return shape.kinds[parent] is not NodeKind.AND or bool(self._startable[child])


def _share(level: float, among: int) -> float:
    return max(level / among, _SMALLEST_LEVEL)
