"""The eligible leaves: kept from one choice to the next, re-derived only where state changed."""

import numpy as np
from numpy.typing import NDArray

from tasks.definition import NodeKind
from tasks.tree_shape import NO_NODE, TreeShape
from tasks.tree_state import LeafStatus, TreeState

_MAX_STALE = 64
"""With more unread changes than this, deriving everything once is cheaper than editing."""


def derive_eligible(shape: TreeShape, state: TreeState, top: int) -> list[int]:
    """The leaves at or under `top` that are eligible if its level is above 0, in tree order."""
    found: list[int] = []
    pending = [top]
    while pending:
        node = pending.pop()
        if state.done[node] or state.abandoned[node]:
            continue
        kind = shape.kinds[node]
        if kind is NodeKind.BEHAVIOR:
            if state.leaf_status[node] is LeafStatus.IDLE:
                found.append(node)
        elif kind is NodeKind.THEN:
            pending.append(state.next_child(node))
        elif kind is NodeKind.OR and state.committed[node] != NO_NODE:
            pending.append(state.committed[node])
        else:
            pending.extend(reversed(shape.children[node]))
    return found


class EligibleLeaves:
    """The eligible leaves of a running tree, in tree order.

    A change only notes the node under which it happened. Every node noted had a level above 0 (or
    was abandoned), and whatever takes that level away later, be it by taking something back, is
    noted later at a node above it; so deriving the noted nodes in turn from the state as it is
    when read gives the same as deriving the whole tree.
    """

    def __init__(self, shape: TreeShape, state: TreeState) -> None:
        self._shape = shape
        self._state = state
        self._leaves: NDArray[np.int64] = np.empty(0, dtype=np.int64)
        self._stale: list[int] = [0]

    def note_change(self, node: int) -> None:
        """Say that the eligible leaves at or under a node may have changed."""
        self._stale.append(node)
        if len(self._stale) > _MAX_STALE:
            self._stale = [0]

    def read(self) -> NDArray[np.int64]:
        """The eligible leaves now; the array must not be changed and is never changed later."""
        if self._stale:
            for node in self._stale:
                self._derive_again(node)
            self._stale.clear()
            self._leaves.setflags(write=False)
        return self._leaves

    def _derive_again(self, node: int) -> None:
        leaves = self._leaves
        fresh = derive_eligible(self._shape, self._state, node)
        low = int(leaves.searchsorted(node))
        high = int(leaves.searchsorted(self._shape.ends[node]))
        if high - low == len(fresh) == 0:
            return
        self._leaves = np.concatenate((leaves[:low], np.array(fresh, np.int64), leaves[high:]))
