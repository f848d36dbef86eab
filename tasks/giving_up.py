"""Giving up: which alternative of which OR is abandoned when a leaf cannot be done."""

from dataclasses import dataclass

from mend.tasks.definition import NodeKind
from mend.tasks.tree_shape import TreeShape
from mend.tasks.tree_state import LeafStatus, TreeState


@dataclass(frozen=True, slots=True)
class GiveUp:
    """What to do so that the run can go on without a leaf.

    First put back every leaf of `put_back` (all that is active under the alternative), then
    abandon `alternative`.
    """

    alternative: int
    put_back: tuple[int, ...]


def find_give_up(shape: TreeShape, state: TreeState, leaf: int) -> GiveUp | None:
    """The nearest alternative above (or at) a leaf that may be abandoned; None if there is none.

    It is a child of an OR with nothing done under it and with another child that is not abandoned.
    """
    node = leaf
    while node != 0 and not state.done_leaves[node]:
        parent = shape.parents[node]
        if shape.kinds[parent] is NodeKind.OR and _has_other_alternative(shape, state, node):
            active = find_active_leaves(shape, state, node)
            return GiveUp(alternative=node, put_back=tuple(active))
        node = parent
    return None


def find_active_leaves(shape: TreeShape, state: TreeState, top: int) -> list[int]:
    """The active leaves at or under a node, in tree order."""
    found: list[int] = []
    pending = [top]
    while pending:
        node = pending.pop()
        if not state.active_leaves[node]:
            continue
        if state.leaf_status[node] is LeafStatus.ACTIVE:
            found.append(node)
        pending.extend(reversed(shape.children[node]))
    return found


def _has_other_alternative(shape: TreeShape, state: TreeState, alternative: int) -> bool:
    siblings = shape.children[shape.parents[alternative]]
    return any(child != alternative and not state.abandoned[child] for child in siblings)
