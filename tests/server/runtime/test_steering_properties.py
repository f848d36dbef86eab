"""Random trees, steered and done at random: the order holds, and so does what people said."""

from random import Random

import pytest
from broken_constraints import broken_constraints
from full_evaluation import Node, trees
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule
from sampled import sample
from steered_run import ROBOTS, SteeredRun, fingerprint, started
from untruths import kinds_of

from mend.errors import ConflictError, WrongInputError
from mend.server.runtime.run_state import RunState
from mend.server.runtime.steering_views import SetAutonomy, SteerNode
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.steering_rules import SteeringAct

NEEDS = st.lists(st.sampled_from(AutonomyLevel), min_size=1, max_size=4)


class SteeredRuns(RuleBasedStateMachine):
    """Draws what robots do and what people say of one run."""

    @initialize(root=trees(), needs=NEEDS, autonomy=st.sampled_from(AutonomyLevel))
    def begin(self, root: Node, needs: list[AutonomyLevel], autonomy: AutonomyLevel) -> None:
        self.run = SteeredRun(started(root, needs, autonomy))

    @property
    def idle(self) -> list[str]:
        return [each for each in ROBOTS if each not in self.run.state.executions]

    @rule(data=st.data(), act=st.sampled_from(SteeringAct))
    def somebody_steers(self, data: st.DataObject, act: SteeringAct) -> None:
        tree = self.run.state.tree
        node = tree.path_of(data.draw(st.integers(0, len(tree) - 1)))
        view = self.run.steering.offers(node)
        offered = {each.act for each in view.offered}
        assert offered.isdisjoint(each.act for each in view.refused)
        wish = SteerNode.model_validate({"act": str(act), "node": node})
        before = fingerprint(self.run.state)
        if act in offered:
            self.run.steer(wish)
            return
        with pytest.raises((ConflictError, WrongInputError)):
            self.run.steer(wish)
        assert fingerprint(self.run.state) == before

    @rule(level=st.sampled_from(AutonomyLevel))
    def somebody_sets_the_level(self, level: AutonomyLevel) -> None:
        wish = SetAutonomy(act="set_autonomy", level=level)
        if level is not self.run.state.steering.level:
            self.run.steer(wish)
            return
        with pytest.raises(ConflictError, match="already"):
            self.run.steer(wish)

    @rule(data=st.data())
    def a_robot_begins(self, data: st.DataObject) -> None:
        startable = self.run.startable()
        if startable and self.idle:
            self.run.start(data.draw(st.sampled_from(startable)), self.idle[0])

    @rule(data=st.data())
    def a_robot_waits(self, data: st.DataObject) -> None:
        state = self.run.state
        eligible = [int(each) for each in state.tree.eligible_leaves()]
        held = [state.steering.hold_on(each, state.taken_back) for each in eligible]
        waiting = [each for each in held if each is not None]
        if waiting:
            hold = data.draw(st.sampled_from(waiting))
            self.run.happens(self.run.steering.held(hold, ROBOTS[0]))
            assert hold in state.held

    @precondition(lambda self: self.run.state.tree.active_leaves())
    @rule(data=st.data(), well=st.booleans(), failed=st.booleans())
    def somebody_is_through(self, data: st.DataObject, well: bool, failed: bool) -> None:
        leaf = data.draw(st.sampled_from(self.run.state.tree.active_leaves()))
        if well:
            self.run.finish(leaf)
        else:
            self.run.put_back(leaf, failed=failed)

    @rule(data=st.data())
    def something_is_gone(self, data: st.DataObject) -> None:
        state = self.run.state
        done = [leaf for leaf in state.tree.leaves if state.tree.done(leaf)]
        done = [leaf for leaf in done if leaf not in state.left_out]
        if done:
            self.run.gone(data.draw(st.sampled_from(done)))

    @precondition(lambda self: self.run.exhausted())
    @rule()
    def what_failed_too_often_is_given_up(self) -> None:
        self.run.give_up(self.run.exhausted()[0])

    @invariant()
    def who_waits_could_begin_were_they_let_go(self) -> None:
        state = self.run.state
        for hold in state.held:
            assert state.tree.eligible(hold.leaf)
            assert state.steering.hold_on(hold.leaf, state.taken_back) is not None

    @invariant()
    def many_leaves_are_held_as_one_by_one(self) -> None:
        state = self.run.state
        leaves = state.tree.eligible_leaves()
        held = state.steering.held_mask(leaves, state.taken_back).tolist()
        for leaf, is_held in zip(leaves.tolist(), held, strict=True):
            assert is_held == (state.steering.hold_on(leaf, state.taken_back) is not None)

    def teardown(self) -> None:
        if not hasattr(self, "run"):
            return
        state = self.run.state
        assert broken_constraints(self.run.events, kinds_of(self.run.first)) == []
        folded = RunState(self.run.first, {})
        for event in self.run.events[1:]:
            folded.fold(event)
        assert fingerprint(folded) == fingerprint(state)
        self._ends_once_all_is_let_go()
        assert broken_constraints(self.run.events, kinds_of(self.run.first)) == []

    def _ends_once_all_is_let_go(self) -> None:
        steering = self.run.state.steering
        for node in list(steering.breakpoints):
            path = self.run.state.tree.path_of(node)
            self.run.steer(SteerNode(act="remove_breakpoint", node=path))
        if steering.level is not AutonomyLevel.FULL:
            self.run.steer(SetAutonomy(act="set_autonomy", level=AutonomyLevel.FULL))
        for _ in range(len(self.run.state.tree)):
            if self.run.ends(Random(1)):
                return
            # What always asks is let go by hand.
            leaf = int(self.run.state.tree.eligible_leaves()[0])
            path = self.run.state.tree.path_of(leaf)
            self.run.steer(SteerNode(act="go_on", node=path))
        raise AssertionError("nothing holds the run, and it does not end")


TestSteeredRuns = pytest.mark.slow(SteeredRuns.TestCase)
TestSteeredRuns.settings = settings(
    max_examples=sample(25, 150), stateful_step_count=40, deadline=None
)


@settings(max_examples=sample(20, 100), deadline=None)
@given(root=trees(), needs=NEEDS, seed=st.integers(0, 2**32 - 1))
def test_what_was_let_go_one_after_the_other_is_a_run_as_any(
    root: Node, needs: list[AutonomyLevel], seed: int
) -> None:
    run, random = SteeredRun(started(root, needs, AutonomyLevel.OFF)), Random(seed)
    while not run.state.tree.done(0):
        assert run.startable() == []
        leaf = int(random.choice(run.state.tree.eligible_leaves().tolist()))
        run.steer(SteerNode(act="go_on", node=run.state.tree.path_of(leaf)))
        assert run.startable() == [leaf]
        run.start(leaf, ROBOTS[0])
        run.finish(leaf)
    assert broken_constraints(run.events, kinds_of(run.first)) == []
