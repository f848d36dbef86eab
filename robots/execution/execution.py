"""The execution of one behavior: walked, held, resumed, and left by a retreat, on any body."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Generic

from mend.robots.execution.effector import Effector
from mend.robots.execution.execution_state import EXECUTION, ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP, Reaction
from mend.robots.execution.progress import G
from mend.robots.execution.routine import Routine
from mend.robots.execution.watch import Interruption
from mend.robots.link.messages import Finished, Holding, ReportBody, Resume


class Execution(ABC, Generic[G]):
    """Walks one behavior's steps; `run`, `resume` and `retreat` give the routines to drive.

    Only one of them may be under way.
    """

    def __init__(
        self,
        id: str,  # noqa: A002 - the protocol's word
        progress: G,
        effector: Effector[Any],
        report: Callable[[ReportBody], None],
    ) -> None:
        self.id = id
        self._progress, self._effector = progress, effector
        self._report = report

    @property
    def state(self) -> ExecutionState:
        return self._progress.state

    @property
    def step(self) -> int:
        """The step under way, counted from 1; 0 before the first."""
        return self._progress.step

    @property
    @abstractmethod
    def fraction(self) -> float:
        """How much of the step under way is done, in [0, 1]."""

    @property
    def over(self) -> bool:
        """Whether nothing can follow."""
        return EXECUTION.is_last(self.state)

    @property
    def object(self) -> str | None:
        """What it handles; None for a behavior that handles nothing."""
        return None

    # --- Routines -----------------------------------------------------------------------------

    def run(self) -> Routine[None]:
        """Do all of it."""
        return self._attempt(resumed=False)

    def resume(self, told: Resume) -> Routine[None]:  # noqa: ARG002 - what concerns one body only
        """Go on after a hold, where the body allows it. Raises `IllegalTransitionError`."""
        self._progress.move_to(ExecutionState.PREPARING)
        return self._attempt(resumed=True)

    def hold(self) -> None:
        """Stop as soon as the body can and hold. Raises `IllegalTransitionError`."""
        self._effector.stop()
        if self.state is not ExecutionState.HOLDING:
            self._progress.move_to(ExecutionState.HOLDING)

    def end(self) -> None:
        """Another execution takes its place. Raises `IllegalTransitionError`."""
        self._effector.be_careful(1.0)
        self._progress.move_to(ExecutionState.ENDED)

    def retreat(self, end: bool) -> Routine[None]:
        """Go to rest, and hold there (or `end`). Raises `IllegalTransitionError`."""
        if self.state is not ExecutionState.RETREATING:
            self._progress.move_to(ExecutionState.RETREATING)
        self._effector.stop()
        return self._retreat(end)

    @abstractmethod
    def _walk(self, *, resumed: bool) -> Routine[bool]:
        """Prepare, walk and confirm; whether there was nothing left to do.

        Raises `Interruption`.
        """

    @abstractmethod
    def _go_to_rest(self) -> Routine[None]:
        """Go where it is in nobody's way, with whatever has to be done for that."""

    def _react(self, interruption: Interruption) -> Routine[None]:
        if interruption.reaction is Reaction.GO_TO_NEUTRAL:
            yield from self.retreat(end=False)
            return
        self._progress.move_to(ExecutionState.HOLDING)
        while self._effector.braking:
            yield
        at_rest = self._effector.at_rest
        self._report(Holding(execution=self.id, at="neutral" if at_rest else "in_place"))

    # --- Within -------------------------------------------------------------------------------

    def _attempt(self, *, resumed: bool) -> Routine[None]:
        try:
            found_in_place = yield from self._walk(resumed=resumed)
        except Interruption as interruption:
            yield from self._react(interruption)
            return
        self._effector.be_careful(1.0)
        self._progress.move_to(ExecutionState.FINISHED)
        self._report(Finished(execution=self.id, found_in_place=found_in_place))

    def _retreat(self, end: bool) -> Routine[None]:
        yield from self._go_to_rest()
        self._effector.be_careful(1.0)
        self._progress.step = BEFORE_FIRST_STEP
        self._progress.move_to(ExecutionState.ENDED if end else ExecutionState.HOLDING)
        self._report(Holding(execution=self.id, at="neutral"))


AnyExecution = Execution[Any]
