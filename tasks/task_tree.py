"""The task tree at run time: its state, its transitions and what may be started next."""

from collections import deque
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mend.errors import IllegalTransitionError
from mend.tasks.activation import FullEvaluation, level_of
from mend.tasks.choice import choose_leaf
from mend.tasks.definition import BehaviorNode, NodeKind, TaskTreeDefinition
from mend.tasks.eligible import EligibleLeaves
from mend.tasks.giving_up import GiveUp, find_active_leaves, find_give_up
from mend.tasks.node_table import NodeTable
from mend.tasks.resolution import Resolution
from mend.tasks.taking_back import TakeBack, find_begun_after, find_take_back
from mend.tasks.tree_shape import NO_NODE
from mend.tasks.tree_state import LeafStatus, TreeState


class TaskTree:
    """A task tree while it runs. A node is its index; the root is 0.

    After a change the work is that of the path from the leaf to the root, and a choice costs what
    the eligible leaves do, however large the tree. All methods that take a leaf raise ValueError
    for a goal node.
    """

    def __init__(self, definition: TaskTreeDefinition | NodeTable) -> None:
        nodes = (
            NodeTable.of(definition) if isinstance(definition, TaskTreeDefinition) else definition
        )
        self.nodes = nodes
        self.running = False
        """Whether the root's level is 1 (the run is running) or 0 (paused, or not begun)."""
        self._shape = nodes.shape
        self._state = TreeState(self._shape)
        self._eligible = EligibleLeaves(self._shape, self._state)
        self._owners: dict[int, str] = {}
        self._attempts: NDArray[np.int64] = np.zeros(len(self._shape), dtype=np.int64)

    def copy(self) -> "TaskTree":
        """A tree in the same state, to try out what would follow from a transition."""
        copied = type(self).__new__(type(self))
        copied.nodes, copied.running, copied._shape = self.nodes, self.running, self._shape
        copied._state = self._state.copy()
        copied._eligible = self._eligible.of(copied._state)
        copied._owners = self._owners.copy()
        copied._attempts = self._attempts.copy()
        return copied

    # What never changes

    def __len__(self) -> int:
        return len(self._shape)

    @property
    def leaves(self) -> Sequence[int]:
        """All leaves, in tree order."""
        return self._shape.leaves

    def index_of(self, path: str) -> int:
        """The node at a path (`/0/2/1`). Raises `NotFoundError` if there is none."""
        return self._shape.index_of(path)

    def path_of(self, node: int) -> str:
        """The path of child indices from the root to a node; `/` is the root."""
        return self._shape.path_of(node)

    def kind_of(self, node: int) -> NodeKind:
        return self._shape.kinds[node]

    def name_of(self, node: int) -> str:
        return self.nodes.names[node]

    def parent_of(self, node: int) -> int | None:
        parent = self._shape.parents[node]
        return None if parent == NO_NODE else parent

    def leaf_definition(self, leaf: int) -> BehaviorNode:
        """A leaf's behavior and its parameters."""
        definition = self.nodes.leaf(leaf)
        if definition is None:
            raise ValueError(f"{self._describe(leaf)} is a goal node, not a leaf")
        return definition

    # State, as derived from what became of the leaves

    def active(self, node: int) -> bool:
        """Whether a leaf is active, or anything under a goal node is."""
        return self._state.active_leaves[node] > 0

    def done(self, node: int) -> bool:
        return bool(self._state.done[node])

    def abandoned(self, node: int) -> bool:
        """Whether a node, or an alternative that it lies under, is given up for good."""
        return bool(self._state.abandoned[node])

    def owner(self, node: int) -> str | None:
        """The agent that holds a leaf: from its start until it is done or put back."""
        return self._owners.get(node)

    def attempts(self, leaf: int) -> int:
        """How many attempts of a leaf have failed."""
        return int(self._attempts[leaf])

    def attempts_of(self, leaves: NDArray[np.int64]) -> NDArray[np.int64]:
        """How many attempts of each of several leaves have failed."""
        return self._attempts[leaves]

    def committed(self, or_node: int) -> int | None:
        """The child of an OR under which anything is active or done, if there is one."""
        child = self._state.committed[or_node]
        return None if child == NO_NODE else child

    def touched(self, node: int) -> bool:
        """Whether anything at or under a node is active or done."""
        return self._state.touched(node)

    def comes_first(self, node: int) -> int | None:
        """The earlier child of a THEN that has to be done before this one may begin, if any."""
        parent = self._shape.parents[node]
        if parent == NO_NODE or self._shape.kinds[parent] is not NodeKind.THEN:
            return None
        first = self._state.next_child(parent)
        earlier = first != NO_NODE and self._shape.positions[first] < self._shape.positions[node]
        return first if earlier else None

    def active_leaves(self) -> list[int]:
        """The active leaves, in tree order."""
        return find_active_leaves(self._shape, self._state, 0)

    def end_of(self, node: int) -> int:
        """The index after the last node under a node: what is under it lies between the two."""
        return self._shape.ends[node]

    def level(self, node: int) -> float:
        """The activation level of a node."""
        return level_of(self._shape, self._state, node) if self.running else 0.0

    def levels(self) -> list[float]:
        """The activation level of every node."""
        return _evaluated(self.evaluation([0.0] * len(self))).levels.tolist()

    def potentials(self, leaf_potentials: Mapping[int, float]) -> list[float]:
        """The activation potential of every node, from those of the leaves (0 where not given)."""
        by_node = [leaf_potentials.get(node, 0.0) for node in range(len(self))]
        return _evaluated(self.evaluation(by_node)).potentials.tolist()

    def evaluation(self, leaf_potentials: Sequence[float]) -> FullEvaluation:
        """The full evaluation of a tree that does not change meanwhile, to be made in pieces.

        `leaf_potentials` by node; those of goal nodes are not looked at.
        """
        return FullEvaluation(self._shape, self._state, leaf_potentials, running=self.running)

    def finished_objects(self) -> set[str]:
        """The objects of the leaves that are done."""
        done = np.frombuffer(self._state.done, np.uint8) == 1
        codes = np.unique(self.nodes.object_codes[done])
        return {self.nodes.objects[code] for code in codes.tolist() if code >= 0}

    # What may be started

    def eligible(self, leaf: int) -> bool:
        """Whether a leaf may be started now."""
        idle = self._state.leaf_status[leaf] is LeafStatus.IDLE
        return idle and self.running and not self.done(leaf) and self._reached(leaf)

    def has_its_turn(self, leaf: int) -> bool:
        """Whether a leaf may be started, were the run not paused."""
        idle = self._state.leaf_status[leaf] is LeafStatus.IDLE
        return idle and not self.abandoned(leaf) and self._reached(leaf)

    def eligible_leaves(self) -> NDArray[np.int64]:
        """The leaves that may be started now, in tree order (read-only)."""
        if not self.running:
            return np.empty(0, dtype=np.int64)
        return self._eligible.read()

    def choose(
        self,
        leaves: NDArray[np.int64],
        potentials: NDArray[np.float64],
        able: NDArray[np.bool_],
    ) -> int | None:
        """The leaf that an idle agent takes, of `leaves` (eligible, in tree order).

        `potentials` are the leaves' potentials for this agent, `able` whether its suitability is
        above 0. Returns None if it can do none of them.
        """
        return choose_leaf(leaves, self._attempts[leaves], potentials, able)

    def give_up(self, leaf: int) -> GiveUp | None:
        """What to abandon so that the run goes on without a leaf; None means that it fails.

        Changes nothing. Raises `IllegalTransitionError` if the leaf is done or abandoned.
        """
        status = self._leaf_status(leaf)
        if status is LeafStatus.DONE or self.abandoned(leaf):
            raise self._illegal(leaf, "give up", "not done and not abandoned")
        return find_give_up(self._shape, self._state, leaf)

    def what_to_take_back(self, leaf: int) -> TakeBack:
        """What is done no longer, and what to put back first, if a done leaf is taken back.

        Changes nothing. Raises `IllegalTransitionError` if the leaf is not done.
        """
        self._require_done(leaf, "take back")
        return find_take_back(self._shape, self._state, leaf)

    # Transitions

    def start(self, leaf: int, owner: str) -> None:
        """Make an eligible leaf active. Raises `IllegalTransitionError` if it is not eligible."""
        self._leaf_status(leaf)
        if not self.eligible(leaf):
            raise self._illegal(leaf, "start", "eligible")
        self._owners[leaf] = owner
        self._eligible.note_change(self._state.activate(leaf))

    def finish(self, leaf: int) -> None:
        """Make an active leaf done. Raises `IllegalTransitionError` if it is not active."""
        self._require_active(leaf, "finish")
        del self._owners[leaf]
        opened = self._state.complete(leaf)
        if opened != NO_NODE:
            self._eligible.note_change(opened)

    def put_back(self, leaf: int, *, failed: bool) -> None:
        """Make an active leaf idle again; `failed` counts a failed attempt.

        Raises `IllegalTransitionError` if it is not active.
        """
        self._require_active(leaf, "put back")
        del self._owners[leaf]
        if failed:
            self._attempts[leaf] += 1
        self._eligible.note_change(self._state.release(leaf))

    def resolve(self, leaf: int, resolution: Resolution, *, helped: bool) -> None:
        """Apply a resolution to an active leaf; a retry without help is a failed attempt.

        Raises `IllegalTransitionError` if the leaf is not active.
        """
        self._require_active(leaf, f"resolve as {resolution}")
        if resolution is Resolution.HUMAN_FINISH:
            self.finish(leaf)
        elif resolution is Resolution.ROBOT_RETRY:
            self.put_back(leaf, failed=not helped)

    def take_back(self, leaf: int) -> None:
        """Make a done leaf idle again, as its result is gone; its failed attempts stay.

        Raises `IllegalTransitionError` unless it is done and nothing that a THEN puts after it is
        active or done; `what_to_take_back` says what has to go first.
        """
        self._require_done(leaf, "take back")
        if after := find_begun_after(self._shape, self._state, leaf):
            state = f"followed by {', '.join(self._describe(each) for each in after)}"
            expected = "it to be followed by nothing active or done"
            raise IllegalTransitionError(self._describe(leaf), state, "'take back'", expected)
        self._eligible.note_change(self._state.take_back(leaf))

    def abandon(self, alternative: int) -> None:
        """Give an alternative of an OR up for good.

        Raises `IllegalTransitionError` unless it is a child of an OR, not abandoned, with nothing
        active or done under it and with another alternative that is not abandoned.
        """
        expected = "an alternative of an OR with another one left, with nothing active or done"
        left = [] if self.abandoned(alternative) else self._alternatives_left_besides(alternative)
        if not left or self._state.touched(alternative):
            raise self._illegal(alternative, "abandon", expected)
        self._state.abandon(alternative)
        self._eligible.note_change(alternative)

    def try_again(self, leaf: int) -> None:
        """Do a leaf as if it were new: not done, not given up, without failed attempts.

        Raises `IllegalTransitionError` if it is active, or as `take_back` does.
        """
        if self._leaf_status(leaf) is LeafStatus.ACTIVE:
            raise self._illegal(leaf, "try again", "idle or done")
        if self.done(leaf):
            self.take_back(leaf)
        self._attempts[leaf] = 0
        if self.abandoned(leaf):
            self._state.reopen(leaf)
            # What is before it may have been taken back meanwhile: nobody knows where level is.
            self._eligible.note_change(0)

    def _alternatives_left_besides(self, node: int) -> list[int]:
        parent = self._shape.parents[node]
        if parent == NO_NODE or self._shape.kinds[parent] is not NodeKind.OR:
            return []
        siblings = self._shape.children[parent]
        return [each for each in siblings if each != node and not self.abandoned(each)]

    def _reached(self, node: int) -> bool:
        """Whether level above 0 would reach a node in a running tree."""
        while node != 0:
            if not self._state.open_to(node):
                return False
            node = self._shape.parents[node]
        return True

    def _leaf_status(self, leaf: int) -> LeafStatus:
        if self._shape.kinds[leaf] is not NodeKind.BEHAVIOR:
            raise ValueError(f"{self._describe(leaf)} is a goal node, not a leaf")
        return self._state.leaf_status[leaf]

    def _require_active(self, leaf: int, transition: str) -> None:
        if self._leaf_status(leaf) is not LeafStatus.ACTIVE:
            raise self._illegal(leaf, transition, "active")

    def _require_done(self, leaf: int, transition: str) -> None:
        if self._leaf_status(leaf) is not LeafStatus.DONE:
            raise self._illegal(leaf, transition, "done")

    def _illegal(self, node: int, transition: str, expected: str) -> IllegalTransitionError:
        state = self._describe_state(node)
        return IllegalTransitionError(
            self._describe(node), state, f"'{transition}'", f"it to be {expected}"
        )

    def _describe(self, node: int) -> str:
        return f"'{self.name_of(node)}' ({self.path_of(node)})"

    def _describe_state(self, node: int) -> str:
        if self.abandoned(node):
            return "abandoned"
        if self.done(node):
            return "done"
        if self.active(node):
            owner = self.owner(node)
            return f"active (held by {owner})" if owner else "active"
        if not self.running:
            return "idle in a run that is not running"
        if not self._reached(node):
            return "idle with level 0"
        return f"an idle {self.kind_of(node)} node"


def _evaluated(evaluation: FullEvaluation) -> FullEvaluation:
    deque(evaluation.pieces(), maxlen=0)
    return evaluation
