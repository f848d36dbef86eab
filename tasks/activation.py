"""Activation levels and potentials of a whole tree, or of one node, computed when read.

The rules are those of the design's table, after Blankenburg et al. 2020, Section 3.1.
"""

import math
from collections.abc import Mapping

from tasks.definition import NodeKind
from tasks.tree_shape import NO_NODE, TreeShape
from tasks.tree_state import LeafStatus, TreeState

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


def all_levels(shape: TreeShape, state: TreeState) -> list[float]:
    """The activation level of every node of a running tree."""
    levels = [0.0] * len(shape)
    levels[0] = 0.0 if state.done[0] else 1.0
    for node in range(1, len(shape)):
        parent = shape.parents[node]
        if levels[parent] > 0.0 and not state.done[node] and state.open_to(node):
            levels[node] = levels[parent]
            if shape.kinds[parent] is NodeKind.AND:
                open_children = len(shape.children[parent]) - state.done_children[parent]
                levels[node] = _share(levels[parent], open_children)
    return levels


def all_potentials(
    shape: TreeShape, state: TreeState, leaf_potentials: Mapping[int, float]
) -> list[float]:
    """The activation potential of every node; 0 where it is done or abandoned.

    `leaf_potentials` maps leaves to their potentials; a leaf that it does not hold has 0.
    """
    potentials = [0.0] * len(shape)
    startable = bytearray(len(shape))
    for node in range(len(shape) - 1, -1, -1):
        if state.done[node] or state.abandoned[node]:
            continue
        kind = shape.kinds[node]
        if kind is NodeKind.BEHAVIOR:
            potentials[node] = leaf_potentials.get(node, 0.0)
            startable[node] = state.leaf_status[node] is LeafStatus.IDLE
            continue
        children = _competing_children(shape, state, node)
        startable[node] = any(startable[child] for child in children)
        if kind is NodeKind.AND:
            children = [child for child in children if startable[child]]
        potentials[node] = max((potentials[child] for child in children), default=0.0)
    return potentials


def _competing_children(shape: TreeShape, state: TreeState, goal: int) -> list[int]:
    """The children to which a goal node that is not done passes its level."""
    kind = shape.kinds[goal]
    if kind is NodeKind.THEN:
        return [state.next_child(goal)]
    if kind is NodeKind.OR and state.committed[goal] != NO_NODE:
        return [state.committed[goal]]
    taken_out = state.done if kind is NodeKind.AND else state.abandoned
    return [child for child in shape.children[goal] if not taken_out[child]]


def _share(level: float, among: int) -> float:
    return max(level / among, _SMALLEST_LEVEL)
