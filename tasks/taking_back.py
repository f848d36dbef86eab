"""Taking back: what else is done no longer when a finished leaf's result is gone.

A THEN is a promise that each child is built on the ones before it. So when something done is
taken back, everything that a THEN puts after it goes with it; AND and OR build nothing on it.
"""

from dataclasses import dataclass

from mend.tasks.definition import NodeKind
from mend.tasks.tree_shape import TreeShape
from mend.tasks.tree_state import LeafStatus, TreeState


@dataclass(frozen=True, slots=True)
class TakeBack:
    """What to do so that a leaf is not done any more.

    First put back every leaf of `put_back`, then take back the leaves of `taken_back` in turn: the
    last in the tree first, the leaf itself last, so that no step breaks an order.
    """

    put_back: tuple[int, ...]
    taken_back: tuple[int, ...]


def find_take_back(shape: TreeShape, state: TreeState, leaf: int) -> TakeBack:
    """What goes with a done leaf when it is taken back."""
    after = find_begun_after(shape, state, leaf)
    return TakeBack(
        put_back=tuple(each for each in after if state.leaf_status[each] is LeafStatus.ACTIVE),
        taken_back=(*(each for each in reversed(after) if state.done[each]), leaf),
    )


def find_begun_after(shape: TreeShape, state: TreeState, leaf: int) -> list[int]:
    """The active and done leaves that a THEN puts after a leaf, in tree order."""
    found: list[int] = []
    child, node = leaf, shape.parents[leaf]
    while child != 0:
        if shape.kinds[node] is NodeKind.THEN:
            for later in shape.children[node][shape.positions[child] + 1 :]:
                found += _begun_leaves(shape, state, later)
        child, node = node, shape.parents[node]
    return found


def _begun_leaves(shape: TreeShape, state: TreeState, top: int) -> list[int]:
    found: list[int] = []
    pending = [top]
    while pending:
        node = pending.pop()
        if not state.touched(node):
            continue
        if shape.kinds[node] is NodeKind.BEHAVIOR:
            found.append(node)
        pending.extend(reversed(shape.children[node]))
    return found
