"""How people steer a run: where it waits for them, what it does next, how much it may do alone."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.tasks.autonomy import RECOVERY, AutonomyLevel
from mend.tasks.task_tree import TaskTree


@dataclass(frozen=True, slots=True)
class Word:
    """Who said something, and why as far as they said so."""

    by: str
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Hold:
    """Why a leaf does not begin by itself.

    `breakpoint`: the node before which it stands, the leaf or one above it; None: the run's level
    of autonomy asks for it.
    """

    leaf: int
    breakpoint: int | None


class Steering:
    """What people have said of one run so far. Who may say what is said elsewhere.

    A breakpoint before a node holds as long as nothing at or under that is active or done: so one
    before a goal node holds until its first leaf has begun, and again once all is put back. A leaf
    that was let go begins once.
    """

    def __init__(self, tree: TaskTree, level: AutonomyLevel = AutonomyLevel.FULL) -> None:
        self._tree = tree
        self.level = level
        self.breakpoints: dict[int, Word] = {}
        self.let_go: set[int] = set()
        self.next: tuple[int, Word] | None = None
        """The leaf that is to be begun before all others."""
        self.waiting: dict[int, Hold] = {}
        """Leaves before which an agent was seen to wait; `waits` has those that it still is so."""

    # --- What it says of leaves ---------------------------------------------------------------

    def hold_on(self, leaf: int, again: Collection[int] = ()) -> Hold | None:
        """Why a leaf does not begin by itself; None if it does.

        `again`: the leaves that were done before.
        """
        if leaf in self.let_go:
            return None
        node: int | None = leaf
        while node is not None:
            if node in self.breakpoints and not self._tree.touched(node):
                return Hold(leaf, node)
            node = self._tree.parent_of(node)
        return None if self.level.allows(self.needed(leaf, again)) else Hold(leaf, None)

    def needed(self, leaf: int, again: Collection[int] = ()) -> AutonomyLevel:
        """What level of autonomy a leaf needs now."""
        declared = self._tree.nodes.autonomy_of(leaf)
        recovers = leaf in again or self._tree.attempts(leaf) > 0
        return max(declared, RECOVERY, key=_rank) if recovers else declared

    def held_mask(
        self, leaves: NDArray[np.int64], again: Collection[int] = ()
    ) -> NDArray[np.bool_]:
        """Which of some eligible leaves, in tree order, do not begin by themselves."""
        held = np.zeros(leaves.size, dtype=np.bool_)
        for node in self.breakpoints:
            if not self._tree.touched(node):
                first, last = np.searchsorted(leaves, (node, self._tree.end_of(node)))
                held[first:last] = True
        if not self._allows_all:
            held |= self._needed_ranks(leaves, again) >= self.level.rank
        if self.let_go:
            held &= ~np.isin(leaves, list(self.let_go))
        return held

    def _needed_ranks(self, leaves: NDArray[np.int64], again: Collection[int]) -> NDArray[np.int8]:
        recovers = self._tree.attempts_of(leaves) > 0
        if again:
            recovers |= np.isin(leaves, list(again))
        declared = self._tree.nodes.autonomy_ranks[leaves]
        return np.where(recovers, np.maximum(declared, RECOVERY.rank), declared)

    @property
    def _allows_all(self) -> bool:
        """Whether nothing asks for any leaf because of what it needs."""
        return self.level is AutonomyLevel.FULL and not self._tree.nodes.declares_autonomy

    @property
    def waits(self) -> list[Hold]:
        """The leaves before which somebody waits to be let go, in tree order."""
        found = (self.waiting[leaf] for leaf in sorted(self.waiting))
        return [each for each in found if self._still_holds(each)]

    def _still_holds(self, hold: Hold) -> bool:
        # Where another reason is left whoever waits for it says so anew.
        before = hold.breakpoint
        holds = before is None or (before in self.breakpoints and not self._tree.touched(before))
        return holds and self._tree.has_its_turn(hold.leaf)

    @property
    def preferred(self) -> int | None:
        """The leaf that is to be begun next, if its turn has come."""
        if self.next is None or not self._tree.has_its_turn(self.next[0]):
            return None
        return self.next[0]

    # --- What people say ----------------------------------------------------------------------

    def set_breakpoint(self, node: int, word: Word) -> None:
        """Wait before a node."""
        self.breakpoints[node] = word
        self.let_go = {each for each in self.let_go if not self._is_under(each, node)}

    def remove_breakpoint(self, node: int) -> None:
        """Wait before it no longer."""
        self.breakpoints.pop(node, None)
        # Whoever still has a reason to wait says so anew.
        self.waiting.clear()

    def release(self, leaf: int) -> None:
        """Let a leaf begin once, whatever holds it."""
        self.let_go.add(leaf)
        self.waiting.pop(leaf, None)

    def prefer(self, leaf: int, word: Word) -> None:
        """Begin a leaf before all others; the last word counts."""
        self.next = leaf, word

    def prefer_nothing(self) -> None:
        """Choose as ever."""
        self.next = None

    def set_level(self, level: AutonomyLevel) -> None:
        """Allow so much from now on."""
        self.level = level
        self.waiting.clear()

    # --- What becomes of leaves ---------------------------------------------------------------

    def wait(self, hold: Hold) -> None:
        """An agent waits before a leaf."""
        self.waiting[hold.leaf] = hold

    def begun(self, leaf: int) -> None:
        """A leaf has begun, or counts as done: what was said of its beginning is carried out."""
        self.let_go.discard(leaf)
        self.waiting.pop(leaf, None)
        if self.next is not None and self.next[0] == leaf:
            self.next = None

    def _is_under(self, leaf: int, node: int) -> bool:
        return node <= leaf < self._tree.end_of(node)


def _rank(level: AutonomyLevel) -> int:
    return level.rank
