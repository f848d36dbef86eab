"""The execution of one behavior: its steps walked on a body, watched by monitors."""

from collections.abc import Callable, Sequence
from typing import Any

from robots.arm import Arm, Routine
from robots.behaviors.assignment import Assignment
from robots.behaviors.backing_off import get_out_of_view
from robots.behaviors.confirmation import look_at_outcome
from robots.behaviors.covering import CoveredResultGone
from robots.behaviors.execution_state import ExecutionState, ExecutionTransitionError, is_over
from robots.behaviors.phase import Phase
from robots.behaviors.plan import make_plan
from robots.behaviors.planning import Plan
from robots.behaviors.preparation import (
    LOOK_AGAIN_S,
    check_carrying,
    check_sight,
    find,
    goes_on_carrying,
)
from robots.behaviors.progress import Progress
from robots.behaviors.put_down import put_down, set_down
from robots.behaviors.step_walk import StepWalk
from robots.behaviors.watch import Interruption, Watch
from robots.body import ToolPose
from robots.catalogue import Part
from robots.link.messages import Finished, Holding, Location, ReportBody, Resumed
from robots.monitors.monitor import BEFORE_FIRST_STEP, Meanwhile, Monitor
from robots.senses import Senses
from robots.vision.head import HeadSighting
from robots.vision.obstruction import Obstruction
from robots.vision.presence import Presence, is_at


class Execution:
    """Walks one behavior's steps; `run`, `resume` and `retreat` give the routines to drive.

    Only one of them may be under way. Reports go to `report`.
    """

    def __init__(
        self,
        assignment: Assignment,
        monitors: Sequence[Monitor[Any]],
        arm: Arm,
        senses: Senses,
        report: Callable[[ReportBody], None],
    ) -> None:
        self._assignment = assignment
        self._arm = arm
        self._senses = senses
        self._report = report
        self._progress = Progress(assignment.was_done)
        self._watch = Watch(assignment, self._progress, monitors, arm, senses, report)
        self._walk = StepWalk(assignment, self._progress, self._watch, arm, senses, report)
        self._picked_at: ToolPose | None = None

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
        return is_over(self.state)

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

    # --- Routines -----------------------------------------------------------------------------

    def run(self) -> Routine[None]:
        """Look, plan and walk all steps."""
        return self._attempt(resumed=False)

    def resume(self) -> Routine[None]:
        """Go on after a hold, where the hands allow it. Raises `ExecutionTransitionError`."""
        self._progress.move_to(ExecutionState.PREPARING)
        return self._attempt(resumed=True)

    def hold(self) -> None:
        """Stop within one control cycle and hold. Raises `ExecutionTransitionError`."""
        self._arm.stop()
        if self.state is not ExecutionState.HOLDING:
            self._progress.move_to(ExecutionState.HOLDING)

    def end(self) -> None:
        """Another execution takes its place. Raises `ExecutionTransitionError`."""
        self._arm.be_careful(1.0)
        self._progress.move_to(ExecutionState.ENDED)

    def retreat(self, end: bool) -> Routine[None]:
        """Put down or let go what is held, move to neutral, and hold there (or `end`).

        Raises `ExecutionTransitionError`.
        """
        if self.state is not ExecutionState.RETREATING:
            self._progress.move_to(ExecutionState.RETREATING)
        self._arm.stop()
        return self._retreat(end)

    def _retreat(self, end: bool) -> Routine[None]:
        yield from put_down(self._arm, self._senses, self._picked_at)
        yield from self._arm.go_to_neutral()
        self._arm.be_careful(1.0)
        self._progress.step = BEFORE_FIRST_STEP
        self._progress.move_to(ExecutionState.ENDED if end else ExecutionState.HOLDING)
        self._report(Holding(execution=self.id, at="neutral"))

    def _attempt(self, resumed: bool) -> Routine[None]:
        self._progress.felt, self._progress.inexact = None, False
        self._progress.regrasps = 0
        try:
            there = False
            while not there:
                plan = yield from self._prepare()
                if plan is None:
                    own = self._progress.inexact or self._progress.unconfirmed
                    self._finish(found_in_place=not own)
                    return
                self._progress.unconfirmed = False
                self._progress.move_to(ExecutionState.RUNNING)
                if resumed:
                    self._report(Resumed(execution=self.id, step=plan.first))
                    resumed = False
                there = (yield from self._walk.take_all(plan)) and (yield from self._confirm())
            self._finish(found_in_place=False)
        except Interruption as interruption:
            yield from self._react(interruption.monitor.meanwhile)
        except CoveredResultGone:
            # The service has every result looked at before it lets this go on.
            yield from self.retreat(end=False)

    # --- Before the first step ----------------------------------------------------------------

    def _prepare(self) -> Routine[Plan | None]:
        """The plan to walk; None if there is nothing left to do. Raises `Interruption`."""
        progress, watch = self._progress, self._watch
        earlier, before = progress.plan, progress.seen.sighting
        progress.start_again()
        part, arm, senses, seen = self._assignment.part, self._arm, self._senses, progress.seen
        senses.want(part)
        carrying = yield from check_carrying(part, arm, senses)
        seen.carrying = carrying and goes_on_carrying(self._assignment, arm, senses)
        if seen.carrying:
            yield from check_sight(arm, senses, seen)
            self._require_sight()
            progress.plan = yield from make_plan(self._assignment, arm, senses, seen)
            refused = progress.plan is None and seen.refusal is not None
            if refused and (yield from set_down(arm, senses, self._picked_at)):
                # Held otherwise it may fit.
                progress.start_again()
                seen = progress.seen
        if not seen.carrying:
            yield from put_down(arm, senses, self._picked_at)
            yield from get_out_of_view(progress, arm, watch)
            yield from find(part, arm, senses, seen)
            self._require_sight()
            if self._in_place() and not progress.inexact:
                return None
            if progress.felt is not None and self._is_hidden(before):
                progress.plan = earlier
                watch.judge(progress.felt)
            self._picked_at = None
            progress.plan = yield from make_plan(self._assignment, arm, senses, seen)
            if seen.sighting is not None and (progress.plan is None or seen.obstruction):
                yield from self._plan_anew()
        if progress.plan is None and progress.inexact and self._in_place():
            # There is no way to place it better.
            return None
        watch.check(senses.read_grip() if seen.carrying else None)
        if progress.felt is not None and progress.felt.tries >= len(watch.tries(Phase.PREPARE)):
            # Nothing that is seen explains it.
            watch.judge(progress.felt)
        if progress.plan is None:
            raise ExecutionTransitionError(
                f"expected a path for {self._assignment.behavior.name} or an issue, got neither"
            )
        self._picked_at = progress.plan.picked_at or self._picked_at
        return progress.plan

    def _plan_anew(self) -> Routine[None]:
        """Look and plan once more: what one picture shows may be wrong."""
        progress = self._progress
        progress.start_again()
        self._senses.doubt()
        yield from self._arm.wait(LOOK_AGAIN_S)
        yield from find(self._assignment.part, self._arm, self._senses, progress.seen)
        self._require_sight()
        progress.plan = yield from make_plan(
            self._assignment, self._arm, self._senses, progress.seen
        )

    def _require_sight(self) -> None:
        """Raises `Interruption` where the head camera shows nothing of the table."""
        blind = self._progress.seen.blind
        if blind is not None:
            self._watch.check(None)
            raise ExecutionTransitionError(f"expected an issue, as {blind}, got none")

    def _in_place(self) -> bool:
        seen, target = self._progress.seen, self._assignment.target
        part, senses = self._assignment.part, self._senses
        if part is None or target is None or seen.image is None:
            return False
        sighting, catalogue = seen.sighting, senses.catalogue
        if sighting is not None and is_at(sighting, target, catalogue.height_of(target)):
            return True
        # What is out of sight at its place since it was seen there needs nobody to fetch it.
        hidden = senses.presence(seen.image, part, target) is Presence.HIDDEN
        return self._progress.was_done == "there" and hidden

    def _is_hidden(self, before: HeadSighting | None) -> bool:
        """Whether something may hide the object where it was seen before."""
        part, seen = self._assignment.part, self._progress.seen
        if seen.sighting is not None or part is None or seen.image is None or before is None:
            return False
        where = Location(x=before.x, y=before.y, z=before.z, yaw=before.yaw)
        return self._senses.presence(seen.image, part, where) is Presence.HIDDEN

    # --- After the steps ----------------------------------------------------------------------

    def _confirm(self) -> Routine[bool]:
        """Whether the object is at its place, as far as is seen; if not, it is to be placed again.

        Raises `Interruption`.
        """
        part, target = self._assignment.part, self._assignment.target
        if part is None or target is None:
            return True
        self._progress.move_to(ExecutionState.CONFIRMING)
        self._arm.be_careful(1.0)
        outcome = yield from look_at_outcome(part, target, self._arm, self._senses)
        self._progress.outcome = outcome
        self._progress.unconfirmed = outcome.blind is not None
        self._watch.check(None)
        if outcome.presence is not Presence.GONE:
            if self._progress.inexact or not outcome.is_inexact(target):
                return True
            self._progress.inexact = True
        self._watch.start_again()
        self._progress.move_to(ExecutionState.PREPARING)
        return False

    def _react(self, meanwhile: Meanwhile) -> Routine[None]:
        if meanwhile is Meanwhile.GO_TO_NEUTRAL:
            # What the fingers may still touch is not theirs to put anywhere any more.
            self._senses.let_go()
            yield from self.retreat(end=False)
            return
        self._progress.move_to(ExecutionState.HOLDING)
        at_neutral = self._arm.at_neutral
        self._report(Holding(execution=self.id, at="neutral" if at_neutral else "in_place"))

    def _finish(self, found_in_place: bool) -> None:
        self._arm.be_careful(1.0)
        self._progress.move_to(ExecutionState.FINISHED)
        self._report(Finished(execution=self.id, found_in_place=found_in_place))
