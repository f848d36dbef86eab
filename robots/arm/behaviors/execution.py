"""The execution of one behavior: its steps walked on a body, watched by monitors."""

from collections.abc import Sequence
from typing import Any

from mend.robots.arm.arm import Routine
from mend.robots.arm.behaviors.confirmation import look_at_outcome
from mend.robots.arm.behaviors.covering import CoveredResultGone
from mend.robots.arm.behaviors.execution_state import EXECUTION, ExecutionState
from mend.robots.arm.behaviors.preparation import prepare
from mend.robots.arm.behaviors.put_down import put_down
from mend.robots.arm.behaviors.step_walk import StepWalk
from mend.robots.arm.behaviors.watch import Interruption, Watch
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.body import ToolPose
from mend.robots.arm.monitors.monitor import BEFORE_FIRST_STEP, Monitor, Reaction
from mend.robots.catalogue import Part
from mend.robots.link.messages import Finished, Holding, Location, Resumed
from mend.robots.vision.obstruction import Obstruction
from mend.robots.vision.presence import Presence


class Execution:
    """Walks one behavior's steps; `run`, `resume` and `retreat` give the routines to drive.

    Only one of them may be under way.
    """

    def __init__(self, work: Work, monitors: Sequence[Monitor[Any]]) -> None:
        self._work = work
        self._assignment, self._progress = work.assignment, work.progress
        self._arm, self._perception = work.arm, work.perception
        self._watch = Watch(work, monitors)
        self._walk = StepWalk(work, self._watch)

    @property
    def id(self) -> str:
        return self._assignment.execution

    @property
    def part(self) -> Part | None:
        return self._assignment.part

    @property
    def state(self) -> ExecutionState:
        return self._progress.state

    @property
    def step(self) -> int:
        """The step under way, counted from 1; 0 before the first."""
        return self._progress.step

    @property
    def over(self) -> bool:
        """Whether nothing can follow."""
        return EXECUTION.is_last(self.state)

    @property
    def way(self) -> list[ToolPose]:
        """The poses that the steps still to come lead through."""
        return self._progress.way

    @property
    def obstruction(self) -> Obstruction | None:
        """What was last seen to be in that way."""
        return self._progress.seen.obstruction

    @property
    def destination(self) -> tuple[Part, Location | None] | None:
        """The object and where it goes; None for a behavior without."""
        part = self._assignment.part
        return None if part is None else (part, self._assignment.target)

    @property
    def unconfirmed(self) -> tuple[Part, Location] | None:
        """The object and its place, if it was placed there and that could not be seen."""
        return self._work.unconfirmed

    # --- Routines -----------------------------------------------------------------------------

    def run(self) -> Routine[None]:
        """Look, plan and walk all steps."""
        return self._attempt(resumed=False)

    def resume(self) -> Routine[None]:
        """Go on after a hold, where the hands allow it. Raises `IllegalTransitionError`."""
        self._progress.move_to(ExecutionState.PREPARING)
        return self._attempt(resumed=True)

    def hold(self) -> None:
        """Stop within one control cycle and hold. Raises `IllegalTransitionError`."""
        self._arm.stop()
        if self.state is not ExecutionState.HOLDING:
            self._progress.move_to(ExecutionState.HOLDING)

    def end(self) -> None:
        """Another execution takes its place. Raises `IllegalTransitionError`."""
        self._arm.be_careful(1.0)
        self._progress.move_to(ExecutionState.ENDED)

    def retreat(self, end: bool) -> Routine[None]:
        """Put down or let go what is held, move to neutral, and hold there (or `end`).

        Raises `IllegalTransitionError`.
        """
        if self.state is not ExecutionState.RETREATING:
            self._progress.move_to(ExecutionState.RETREATING)
        self._arm.stop()
        return self._retreat(end)

    def _retreat(self, end: bool) -> Routine[None]:
        yield from put_down(self._arm, self._perception, self._progress.picked_at)
        yield from self._arm.go_to_neutral()
        self._arm.be_careful(1.0)
        self._progress.step = BEFORE_FIRST_STEP
        self._progress.move_to(ExecutionState.ENDED if end else ExecutionState.HOLDING)
        self._work.report(Holding(execution=self.id, at="neutral"))

    def _attempt(self, resumed: bool) -> Routine[None]:
        self._progress.felt, self._progress.inexact = None, False
        self._progress.regrasps = 0
        self._progress.as_found &= not resumed
        try:
            there = False
            while not there:
                plan = yield from prepare(self._work, self._watch)
                if plan is None:
                    own = not self._progress.as_found and (
                        self._progress.inexact or self._progress.unconfirmed
                    )
                    self._finish(found_in_place=not own)
                    return
                self._progress.unconfirmed = self._progress.as_found = False
                self._progress.move_to(ExecutionState.RUNNING)
                if resumed:
                    self._work.report(Resumed(execution=self.id, step=plan.first))
                    resumed = False
                there = (yield from self._walk.take_all(plan)) and (yield from self._confirm())
            self._finish(found_in_place=False)
        except Interruption as interruption:
            yield from self._react(interruption.monitor.reaction)
        except CoveredResultGone:
            # The service has every result looked at before it lets this go on.
            yield from self.retreat(end=False)

    def _confirm(self) -> Routine[bool]:
        """Whether the object is at its place, as far as is seen; if not, it is to be placed again.

        Raises `Interruption`.
        """
        part, target = self._assignment.part, self._assignment.target
        if part is None or target is None:
            return True
        self._progress.move_to(ExecutionState.CONFIRMING)
        self._arm.be_careful(1.0)
        self._expect_change()
        outcome = yield from look_at_outcome(part, target, self._arm, self._perception)
        self._progress.outcome = outcome
        self._progress.unconfirmed = outcome.blind is not None
        self._watch.check(None)
        if outcome.presence is not Presence.GONE:
            if self._progress.inexact or not outcome.is_inexact(part, target):
                return True
            self._progress.inexact = True
        else:
            self._progress.inexact = False
        self._watch.start_again()
        self._progress.move_to(ExecutionState.PREPARING)
        return False

    def _expect_change(self) -> None:
        """What was seen where it started, and was carried away, cannot be seen there any more."""
        before = self._progress.seen
        if before.image is not None and before.sighting is not None and self._progress.picked_at:
            self._perception.head.expect_change(before.image)

    def _react(self, reaction: Reaction) -> Routine[None]:
        if reaction is Reaction.GO_TO_NEUTRAL:
            # What the fingers may still touch is not theirs to put anywhere any more.
            self._perception.let_go()
            yield from self.retreat(end=False)
            return
        self._progress.move_to(ExecutionState.HOLDING)
        at_neutral = self._arm.at_neutral
        self._work.report(Holding(execution=self.id, at="neutral" if at_neutral else "in_place"))

    def _finish(self, found_in_place: bool) -> None:
        self._arm.be_careful(1.0)
        self._progress.move_to(ExecutionState.FINISHED)
        self._work.report(Finished(execution=self.id, found_in_place=found_in_place))
