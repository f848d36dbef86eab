"""The state of a task tree: what became of each leaf, and what follows from it for goal nodes.

Everything here is bookkeeping along one path to the root; whether a transition is legal is the
task tree's concern.
"""

from array import array
from enum import StrEnum
from typing import Self

from mend.tasks.definition import NodeKind
from mend.tasks.tree_shape import NO_NODE, TreeShape

_THEN = NodeKind.THEN
_OR = NodeKind.OR


class LeafStatus(StrEnum):
    """What a leaf is doing."""

    IDLE = "idle"
    ACTIVE = "active"
    DONE = "done"


class TreeState:
    """Leaf states and, per node, the counts from which the state of goal nodes is derived."""

    def __init__(self, shape: TreeShape) -> None:
        size = len(shape)
        self._shape = shape
        self.leaf_status: list[LeafStatus] = [LeafStatus.IDLE] * size
        """Meaningful for leaves only."""
        self.idle = bytearray(b"\x01" * size)
        """Whether a leaf is; meaningful for leaves only."""
        self.active_leaves = array("q", [0]) * size
        """How many leaves under a node (or the leaf itself) are active."""
        self.done_leaves = array("q", [0]) * size
        """How many leaves under a node (or the leaf itself) are done."""
        self.done_children = array("q", [0]) * size
        self.done = bytearray(size)
        self.given_up: set[int] = set()
        """The alternatives that were abandoned themselves."""
        self.abandoned = bytearray(size)
        """Set for an abandoned alternative and every node under it."""
        self.committed = array("q", [NO_NODE]) * size
        """The child to which an OR is committed, else NO_NODE."""

    def copy(self) -> Self:
        """The same state, which can be changed without changing this one."""
        copied = type(self).__new__(type(self))
        copied._shape = self._shape
        copied.leaf_status = self.leaf_status[:]
        copied.idle = self.idle[:]
        copied.active_leaves = self.active_leaves[:]
        copied.done_leaves = self.done_leaves[:]
        copied.done_children = self.done_children[:]
        copied.done = self.done[:]
        copied.given_up = self.given_up.copy()
        copied.abandoned = self.abandoned[:]
        copied.committed = self.committed[:]
        return copied

    def _become(self, leaf: int, status: LeafStatus) -> None:
        self.leaf_status[leaf] = status
        self.idle[leaf] = status is LeafStatus.IDLE

    def next_child(self, then: int) -> int:
        """A THEN's first child that is not done, NO_NODE if all are."""
        # Children of a THEN become done in order and are taken back in reverse, so their number
        # is the position.
        children = self._shape.children[then]
        position = self.done_children[then]
        return children[position] if position < len(children) else NO_NODE

    def touched(self, node: int) -> bool:
        """Whether anything at or under a node is active or done."""
        return self.active_leaves[node] > 0 or self.done_leaves[node] > 0

    def open_to(self, child: int) -> bool:
        """Whether its parent would pass a level above 0 on to a child that is not done."""
        parent = self._shape.parents[child]
        kind = self._shape.kinds[parent]
        if kind is _THEN:
            return self.next_child(parent) == child
        if kind is _OR:
            return self.committed[parent] in (NO_NODE, child) and not self.abandoned[child]
        return True

    def activate(self, leaf: int) -> int:
        """Make an idle leaf active; returns the topmost node whose eligible leaves changed."""
        parents, kinds, committed = self._shape.parents, self._shape.kinds, self.committed
        self._become(leaf, LeafStatus.ACTIVE)
        self.active_leaves[leaf] = 1
        changed = leaf
        child, node = leaf, parents[leaf]
        while node != NO_NODE:
            if kinds[node] is _OR and committed[node] == NO_NODE:
                committed[node] = child
                changed = node
            self.active_leaves[node] += 1
            child, node = node, parents[node]
        return changed

    def release(self, leaf: int) -> int:
        """Make an active leaf idle; returns the topmost node whose eligible leaves changed."""
        parents, kinds = self._shape.parents, self._shape.kinds
        self._become(leaf, LeafStatus.IDLE)
        self.active_leaves[leaf] = 0
        changed = leaf
        node = parents[leaf]
        while node != NO_NODE:
            self.active_leaves[node] -= 1
            if kinds[node] is _OR and not self.touched(node):
                self.committed[node] = NO_NODE
                changed = node
            node = parents[node]
        return changed

    def complete(self, leaf: int) -> int:
        """Make an active leaf done; returns the node that this opened, NO_NODE if none."""
        parents, kinds, children = self._shape.parents, self._shape.kinds, self._shape.children
        self._become(leaf, LeafStatus.DONE)
        self.active_leaves[leaf] = 0
        self.done_leaves[leaf] = 1
        self.done[leaf] = True
        opened = NO_NODE
        child_done = True
        node = parents[leaf]
        while node != NO_NODE:
            self.active_leaves[node] -= 1
            self.done_leaves[node] += 1
            if child_done:
                self.done_children[node] += 1
                child_done = kinds[node] is _OR or self.done_children[node] == len(children[node])
                if child_done:
                    self.done[node] = True
                elif kinds[node] is _THEN:
                    opened = self.next_child(node)
            node = parents[node]
        return opened

    def take_back(self, leaf: int) -> int:
        """Make a done leaf idle; returns the topmost node whose eligible leaves changed."""
        parents, kinds = self._shape.parents, self._shape.kinds
        self._become(leaf, LeafStatus.IDLE)
        self.done_leaves[leaf] = 0
        self.done[leaf] = False
        changed = leaf
        child_taken_back = True
        node = parents[leaf]
        while node != NO_NODE:
            self.done_leaves[node] -= 1
            if child_taken_back:
                self.done_children[node] -= 1
                if kinds[node] is _THEN:
                    changed = node
                # A goal node with a child that is done no longer is not done either: even an OR
                # has but one that ever begins.
                child_taken_back = bool(self.done[node])
                if child_taken_back:
                    self.done[node] = False
                    changed = node
            if kinds[node] is _OR and not self.touched(node):
                self.committed[node] = NO_NODE
                changed = node
            node = parents[node]
        return changed

    def abandon(self, alternative: int) -> None:
        """Mark an alternative and everything under it abandoned."""
        self.given_up.add(alternative)
        self._mark(alternative)

    def _mark(self, alternative: int) -> None:
        end = self._shape.ends[alternative]
        self.abandoned[alternative:end] = b"\x01" * (end - alternative)

    def reopen(self, leaf: int) -> None:
        """Take up every abandoned alternative at or above a leaf."""
        above, node = [], leaf
        while node != NO_NODE:
            if node in self.given_up:
                above.append(node)
            node = self._shape.parents[node]
        top = above[-1]
        self.given_up.difference_update(above)
        end = self._shape.ends[top]
        self.abandoned[top:end] = bytes(end - top)
        for each in self.given_up:
            if top < each < end:
                self._mark(each)
