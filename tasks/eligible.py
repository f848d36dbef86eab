"""The eligible leaves: kept from one choice to the next, re-derived only where state changed."""

import numpy as np
from numpy.typing import NDArray

from mend.tasks.definition import NodeKind
from mend.tasks.tree_shape import AND_CODE, LEAF_CODE, NO_NODE, OR_CODE, THEN_CODE, TreeShape
from mend.tasks.tree_state import TreeState

_MAX_STALE = 64
"""With more unread changes than this, deriving everything once is cheaper than editing."""
_MANY = 128
"""So many nodes of one depth are derived faster as an array than one by one."""


def derive_eligible(shape: TreeShape, state: TreeState, top: int) -> NDArray[np.int64]:
    """The leaves at or under `top` that are eligible if its level is above 0, in tree order."""
    found: list[int] = []
    arrays: list[NDArray[np.int64]] = []
    depth = [top]
    while depth:
        if len(depth) < _MANY:
            depth = _below(shape, state, depth, found)
        else:
            leaves, below = _below_many(shape, state, np.array(depth, dtype=np.int64))
            arrays.append(leaves)
            depth = below.tolist()
    return np.sort(np.concatenate((np.array(found, dtype=np.int64), *arrays)))


def _below(shape: TreeShape, state: TreeState, nodes: list[int], found: list[int]) -> list[int]:
    """The nodes to which `nodes` pass their level; adds the eligible leaves to `found`."""
    below: list[int] = []
    for node in nodes:
        if state.done[node] or state.abandoned[node]:
            continue
        kind = shape.kinds[node]
        if kind is NodeKind.BEHAVIOR:
            if state.idle[node]:
                found.append(node)
        elif kind is NodeKind.THEN:
            below.append(state.next_child(node))
        elif kind is NodeKind.OR and state.committed[node] != NO_NODE:
            below.append(state.committed[node])
        else:
            below.extend(shape.children[node])
    return below


def _below_many(
    shape: TreeShape, state: TreeState, nodes: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The eligible leaves among `nodes`, and the nodes to which the others pass their level."""
    taken_out = np.frombuffer(state.done, np.uint8) | np.frombuffer(state.abandoned, np.uint8)
    nodes = nodes[taken_out[nodes] == 0]
    codes = shape.codes[nodes]
    leaves = nodes[codes == LEAF_CODE]
    leaves = leaves[np.frombuffer(state.idle, np.uint8)[leaves] == 1]
    thens, ors = nodes[codes == THEN_CODE], nodes[codes == OR_CODE]
    children, starts = shape.family
    done_children = np.frombuffer(state.done_children, np.int64)
    committed = np.frombuffer(state.committed, np.int64)[ors]
    everything = np.concatenate((nodes[codes == AND_CODE], ors[committed == NO_NODE]))
    return leaves, np.concatenate(
        (
            children[starts[thens] + done_children[thens]],
            committed[committed != NO_NODE],
            shape.children_of_all(everything),
        )
    )


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

    def of(self, state: TreeState) -> "EligibleLeaves":
        """Those of a state that is the same now."""
        copied = EligibleLeaves(self._shape, state)
        copied._leaves, copied._stale = self._leaves, self._stale.copy()
        return copied

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
        self._leaves = np.concatenate((leaves[:low], fresh, leaves[high:]))
