"""Random trees and random sequences: the incremental tree equals a full evaluation, always."""

from fractions import Fraction
from typing import Any
from unittest import mock

import numpy as np
import pytest
from full_evaluation import Node, define, trees
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule
from sampled import sample

from mend.errors import IllegalTransitionError
from mend.tasks import eligible
from mend.tasks.resolution import Resolution
from mend.tasks.task_tree import TaskTree


class TreeAgainstFullEvaluation(RuleBasedStateMachine):
    """Drives a task tree and a plain nested tree by the same steps."""

    @initialize(root=trees())
    def begin(self, root: Node) -> None:
        self.root = root
        self.plain = list(root.walk())
        self.tree = TaskTree(define(root))
        self.tree.running = True
        self.given_up: list[Node] = []

    def pick(self, data: st.DataObject, status: str) -> int:
        found = [i for i in self.tree.leaves if self.plain[i].status == status]
        return data.draw(st.sampled_from(found))

    def some(self, status: str) -> bool:
        return any(leaf.status == status for leaf in self.root.leaves())

    def levels(self) -> list[Any]:
        levels = self.root.spread(Fraction(int(self.tree.running)), {})
        return [levels[node] for node in self.plain]

    def eligible(self) -> list[int]:
        levels = self.levels()
        return [
            i
            for i, node in enumerate(self.plain)
            if node.kind == "leaf" and node.status == "idle" and levels[i] > 0
        ]

    @precondition(lambda self: self.eligible())
    @rule(data=st.data())
    def start_an_eligible_leaf(self, data: st.DataObject) -> None:
        leaf = data.draw(st.sampled_from(self.eligible()))
        self.tree.start(leaf, "pr2")
        self.plain[leaf].status = "active"

    @rule(data=st.data())
    def refuse_to_start_any_other(self, data: st.DataObject) -> None:
        eligible = self.eligible()
        others = [i for i in self.tree.leaves if i not in eligible]
        if others:
            with pytest.raises(IllegalTransitionError):
                self.tree.start(data.draw(st.sampled_from(others)), "pr2")

    @precondition(lambda self: self.some("active"))
    @rule(data=st.data())
    def finish(self, data: st.DataObject) -> None:
        leaf = self.pick(data, "active")
        self.tree.finish(leaf)
        self.plain[leaf].status = "done"

    @precondition(lambda self: self.some("active"))
    @rule(data=st.data(), failed=st.booleans())
    def put_back_after_a_fault(self, data: st.DataObject, failed: bool) -> None:
        leaf = self.pick(data, "active")
        self.tree.put_back(leaf, failed=failed)
        self.plain[leaf].status = "idle"
        self.plain[leaf].attempts += failed

    @precondition(lambda self: self.some("active"))
    @rule(data=st.data(), resolution=st.sampled_from(Resolution), helped=st.booleans())
    def resolve(self, data: st.DataObject, resolution: Resolution, helped: bool) -> None:
        leaf = self.pick(data, "active")
        self.tree.resolve(leaf, resolution, helped=helped)
        if resolution is Resolution.HUMAN_FINISH:
            self.plain[leaf].status = "done"
        elif resolution is Resolution.ROBOT_RETRY:
            self.plain[leaf].status = "idle"
            self.plain[leaf].attempts += not helped

    @precondition(lambda self: self.some("active") or self.some("idle"))
    @rule(data=st.data(), of=st.sampled_from(["active", "idle"]))
    def give_up(self, data: st.DataObject, of: str) -> None:
        if not self.some(of):
            return
        leaf = self.pick(data, of)
        if self.tree.abandoned(leaf):
            return
        give_up = self.tree.give_up(leaf)
        expected = self.expected_alternative(leaf)
        assert (give_up and give_up.alternative) == expected
        if give_up is None:
            return
        under = set(self.plain[give_up.alternative].walk())
        active = [i for i in self.tree.active_leaves() if self.plain[i] in under]
        assert list(give_up.put_back) == active
        for each in give_up.put_back:
            self.tree.put_back(each, failed=False)
            self.plain[each].status = "idle"
        self.tree.abandon(give_up.alternative)
        for node in under:
            node.given_up = True
        self.given_up.append(self.plain[give_up.alternative])

    @rule(data=st.data())
    def try_again(self, data: st.DataObject) -> None:
        leaf = data.draw(st.sampled_from(list(self.tree.leaves)))
        plain = self.plain[leaf]
        if plain.status == "active" or (plain.status == "done" and self.put_after(leaf)):
            with pytest.raises(IllegalTransitionError):
                self.tree.try_again(leaf)
            return
        self.tree.try_again(leaf)
        plain.status, plain.attempts = "idle", 0
        self.given_up = [each for each in self.given_up if plain not in list(each.walk())]
        given_up = {node for each in self.given_up for node in each.walk()}
        for node in self.plain:
            node.given_up = node in given_up

    @precondition(lambda self: self.some("done"))
    @rule(data=st.data(), read_between=st.booleans())
    def take_back(self, data: st.DataObject, read_between: bool) -> None:
        leaf = self.pick(data, "done")
        after = self.put_after(leaf)
        found = self.tree.what_to_take_back(leaf)
        assert list(found.put_back) == [i for i in after if self.plain[i].status == "active"]
        done_after = [i for i in after if self.plain[i].status == "done"]
        assert list(found.taken_back) == [*reversed(done_after), leaf]
        if after:
            with pytest.raises(IllegalTransitionError):
                self.tree.take_back(leaf)
        for each in found.put_back:
            self.tree.put_back(each, failed=False)
            self.plain[each].status = "idle"
        for each in found.taken_back:
            self.tree.take_back(each)
            self.plain[each].status = "idle"
            self.no_constraint_is_violated()
            if read_between:
                self.read_the_eligible_leaves()
        if self.tree.running:
            assert self.tree.eligible(leaf)

    @rule(data=st.data())
    def refuse_to_take_back_what_is_not_done(self, data: st.DataObject) -> None:
        others = [i for i in self.tree.leaves if self.plain[i].status != "done"]
        if others:
            leaf = data.draw(st.sampled_from(others))
            for call in (self.tree.take_back, self.tree.what_to_take_back):
                with pytest.raises(IllegalTransitionError):
                    call(leaf)

    def put_after(self, leaf: int) -> list[int]:
        """What is begun after a leaf by the order of a THEN, judged pair by pair."""
        return [
            other
            for other in self.tree.leaves
            if self.plain[other].status != "idle" and self.is_put_after(other, leaf)
        ]

    def is_put_after(self, other: int, leaf: int) -> bool:
        """Whether the innermost goal node above both is a THEN that has the other one later."""
        theirs, ours = self.tree.path_of(other).split("/"), self.tree.path_of(leaf).split("/")
        shared = next((i for i, (a, b) in enumerate(zip(theirs, ours, strict=False)) if a != b), 0)
        if shared == 0:
            return False
        above = self.tree.index_of("/".join(ours[:shared]) or "/")
        return self.plain[above].kind == "then" and int(theirs[shared]) > int(ours[shared])

    def expected_alternative(self, leaf: int) -> int | None:
        """The rule for giving up, by search through every OR from the innermost outwards."""
        child = leaf
        while (parent := self.tree.parent_of(child)) is not None:
            plain = self.plain[parent]
            finished = any(each.status == "done" for each in self.plain[child].leaves())
            others = [
                each
                for each in plain.children
                if each is not self.plain[child] and not each.given_up
            ]
            if plain.kind == "or" and others and not finished:
                return child
            child = parent
        return None

    @rule(running=st.booleans())
    def pause_or_resume(self, running: bool) -> None:
        self.tree.running = running

    @rule(data=st.data())
    def choose(self, data: st.DataObject) -> None:
        eligible = self.eligible()
        number = st.sampled_from([0.0, 0.5, 1.0, 2.0])
        potentials = {i: data.draw(number) for i in eligible}
        able = {i: data.draw(st.booleans()) for i in eligible}
        ranked = sorted((self.plain[i].attempts, -potentials[i], i) for i in eligible if able[i])
        chosen = self.tree.choose(
            self.tree.eligible_leaves(),
            np.array([potentials[i] for i in eligible], dtype=np.float64),
            np.array([able[i] for i in eligible], dtype=np.bool_),
        )
        assert chosen == (ranked[0][2] if ranked else None)

    @rule()
    def read_the_eligible_leaves(self) -> None:
        # Not an invariant: several changes between two readings must come out right as well.
        assert self.tree.eligible_leaves().tolist() == self.eligible()

    @invariant()
    def state_equals_the_full_evaluation(self) -> None:
        everything = range(len(self.plain))
        assert [self.tree.done(i) for i in everything] == [n.done() for n in self.plain]
        assert [self.tree.active(i) for i in everything] == [n.active() for n in self.plain]
        assert [self.tree.abandoned(i) for i in everything] == [n.given_up for n in self.plain]
        assert [self.tree.eligible(i) for i in self.tree.leaves] == [
            i in self.eligible() for i in self.tree.leaves
        ]
        for i, node in enumerate(self.plain):
            if node.kind == "leaf":
                assert self.tree.attempts(i) == node.attempts
                assert (self.tree.owner(i) is not None) == (node.status == "active")
            if node.kind == "or":
                committed = node.committed()
                expected = None if committed is None else self.plain.index(committed)
                assert self.tree.committed(i) == expected

    @invariant()
    def many_nodes_at_a_time_are_derived_as_one_by_one(self) -> None:
        shape, state = self.tree._shape, self.tree._state
        derived = []
        for many in (1, len(self.plain) + 1):
            with mock.patch.object(eligible, "_MANY", many):
                derived.append(eligible.derive_eligible(shape, state, 0).tolist())
        assert derived[0] == derived[1]

    @invariant()
    def levels_equal_the_full_evaluation(self) -> None:
        expected = [pytest.approx(float(level)) for level in self.levels()]
        assert self.tree.levels() == expected
        assert [self.tree.level(i) for i in range(len(self.plain))] == expected

    @invariant()
    def potentials_equal_the_full_evaluation(self) -> None:
        for i in self.tree.leaves:
            self.plain[i].potential = ((i * 7) % 5) / 4
        given = {i: self.plain[i].potential for i in self.tree.leaves}
        assert self.tree.potentials(given) == [
            0.0 if node.given_up else node.evaluate_potential() for node in self.plain
        ]

    @invariant()
    def no_constraint_is_violated(self) -> None:
        for node in self.plain:
            if node.kind == "then":
                begun = [child.begun() for child in node.children]
                for before, after in zip(node.children, begun[1:], strict=False):
                    assert before.done() or not after, "a THEN's child began before its turn"
            if node.kind == "or":
                assert sum(child.begun() for child in node.children) <= 1, "an OR began two"
        for i, node in enumerate(self.plain):
            if node.kind == "and" and self.tree.done(i):
                assert all(child.done() for child in node.children), "an AND is done too early"


TestTreeAgainstFullEvaluation = pytest.mark.slow(TreeAgainstFullEvaluation.TestCase)
TestTreeAgainstFullEvaluation.settings = settings(
    max_examples=sample(25, 150), stateful_step_count=50, deadline=None
)


@settings(max_examples=40, deadline=None)
@given(root=trees(max_leaves=60), random=st.randoms(use_true_random=False))
def test_every_run_ends_done_or_with_nothing_left_to_give_up(root: Node, random: Any) -> None:
    tree = TaskTree(define(root))
    tree.running = True
    failed = False
    while not tree.done(0) and not failed:
        eligible = tree.eligible_leaves()
        assert eligible.size, "a tree that is neither done nor failed must have a leaf to start"
        leaf = int(random.choice(eligible))
        tree.start(leaf, "pr2")
        if random.random() < 0.6:
            tree.finish(leaf)
        elif tree.attempts(leaf) < 2:
            tree.put_back(leaf, failed=True)
        else:
            give_up = tree.give_up(leaf)
            failed = give_up is None
            if give_up is not None:
                for each in give_up.put_back:
                    tree.put_back(each, failed=True)
                tree.abandon(give_up.alternative)
    assert failed or not tree.eligible_leaves().size
