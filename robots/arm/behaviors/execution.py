"""The execution of one behavior of an arm: what is looked for, planned, walked and confirmed."""

from collections.abc import Sequence
from dataclasses import replace

from mend.robots.arm.behaviors.behavior import Move
from mend.robots.arm.behaviors.confirmation import look_at_outcome
from mend.robots.arm.behaviors.contact import Try
from mend.robots.arm.behaviors.covering import CoveredResultGone
from mend.robots.arm.behaviors.drawing_back import DrawnBack
from mend.robots.arm.behaviors.elsewhere import SeenElsewhere
from mend.robots.arm.behaviors.preparation import prepare
from mend.robots.arm.behaviors.progress import ArmProgress
from mend.robots.arm.behaviors.put_down import put_down
from mend.robots.arm.behaviors.step_walk import StepWalk
from mend.robots.arm.behaviors.watch import ArmWatch
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.body import ToolPose
from mend.robots.catalogue import Part
from mend.robots.execution.execution import Execution
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import AnyMonitor, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.execution.routine import Routine
from mend.robots.execution.watch import Interruption
from mend.robots.link.messages import Location, Resume, Resumed
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.obstruction import Obstruction
from mend.robots.vision.presence import Presence


class ArmExecution(Execution[ArmProgress]):
    """Walks one behavior of an arm."""

    def __init__(self, work: Work, monitors: Sequence[AnyMonitor]) -> None:
        super().__init__(work.assignment.execution, work.progress, work.arm, work.report)
        self._work, self._assignment = work, work.assignment
        self._arm, self._perception = work.arm, work.perception
        self._watch = ArmWatch(work, monitors)
        self._steps = StepWalk(work, self._watch)
        self._drawn_back: DrawnBack | None = None

    @property
    def fraction(self) -> float:
        between = not self._arm.body.moving or self.state is ExecutionState.CONFIRMING
        return 1.0 if between else self._arm.body.progress

    @property
    def object(self) -> str | None:
        part = self._assignment.part
        return None if part is None else part.name

    @property
    def way(self) -> list[ToolPose]:
        """The poses that the steps still to come lead through."""
        return self._progress.way

    @property
    def obstruction(self) -> Obstruction | None:
        """What was last seen to be in that way."""
        return self._progress.seen.obstruction

    @property
    def was_held_up(self) -> bool:
        """Whether it waits on its way through a step, as something was felt there."""
        progress = self._progress
        return progress.contact is not None and bool(progress.way) and progress.step > 0

    @property
    def gentlest_try(self) -> Try:
        """How the step under way is to be tried where something was felt."""
        plan, tries = self._progress.planned, self._watch.tries(Phase.PREPARE)
        action = plan.steps[self._progress.step - 1].action
        own = action.speed if isinstance(action, Move) else 1.0
        return replace(tries[-1], speed=tries[-1].speed * own)

    @property
    def destination(self) -> tuple[Part, Location | None] | None:
        """The object and where it goes; None for a behavior without."""
        part = self._assignment.part
        return None if part is None else (part, self._assignment.target)

    @property
    def unconfirmed(self) -> tuple[Part, Location] | None:
        """The object and its place, if it was placed there and that could not be seen."""
        return self._work.unconfirmed

    def brought_to(self, now: HeadSighting) -> bool | None:
        """Whether what the fingers lost was seen, since then, not to be where it is now.

        None if that was not seen, or nothing was lost.
        """
        return None if self._drawn_back is None else self._drawn_back.brought_to(now)

    def resume(self, told: Resume) -> Routine[None]:
        self._drawn_back = None
        self._progress.object_at = told.object_at
        return super().resume(told)

    # --- What it does -------------------------------------------------------------------------

    def _walk(self, *, resumed: bool) -> Routine[bool]:
        """Look, plan, walk all steps and look again. Raises `Interruption`."""
        progress = self._progress
        progress.felt, progress.inexact = None, False
        progress.regrasps = 0
        progress.as_found &= not resumed
        there = False
        while not there:
            plan = yield from prepare(self._work, self._watch)
            if plan is None:
                own = not progress.as_found and (progress.inexact or progress.unconfirmed)
                return not own
            progress.unconfirmed = progress.as_found = False
            progress.move_to(ExecutionState.RUNNING)
            if resumed:
                self._report(Resumed(execution=self.id, step=plan.first))
                resumed = False
            there = (yield from self._steps.take_all(plan)) and (yield from self._confirm())
        return False

    def _go_to_rest(self) -> Routine[None]:
        """Put down or let go what is held, and move to neutral."""
        drawn_back = self._drawn_back
        way = self._draw_back()
        yield from way if drawn_back is None else drawn_back.during(way, self._arm)

    def _draw_back(self) -> Routine[None]:
        yield from put_down(self._arm, self._perception, self._progress.picked_at)
        yield from self._arm.go_to_neutral()

    def _react(self, interruption: Interruption) -> Routine[None]:
        if not self._arm.at_rest:
            self._perception.head.glance()
        if isinstance(interruption, CoveredResultGone | SeenElsewhere):
            # The service has everything looked at before it lets this go on.
            yield from self.retreat(end=False)
            return
        if interruption.reaction is Reaction.GO_TO_NEUTRAL:
            # The arm is to put nowhere what the fingers may still touch.
            self._perception.let_go()
            if self._assignment.part is not None:
                self._drawn_back = DrawnBack(
                    self._assignment.part, self._perception, self._arm.body.time_s()
                )
        yield from super()._react(interruption)

    def _confirm(self) -> Routine[bool]:
        """Whether the object is at its place, as far as is seen; if not, it is to be placed again.

        Raises `Interruption`.
        """
        part, target = self._assignment.part, self._assignment.target
        if part is None or target is None:
            return True
        self._progress.move_to(ExecutionState.CONFIRMING)
        self._arm.be_careful(1.0)
        self._perception.head.glance()
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
