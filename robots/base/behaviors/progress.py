"""How far a base's execution has come."""

from collections.abc import Sequence
from dataclasses import dataclass

from mend.robots.base.behaviors.behavior import Drive
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP
from mend.robots.execution.phase import Phase
from mend.robots.execution.progress import Progress


@dataclass(slots=True, kw_only=True)
class BaseProgress(Progress):
    """What drives the steps and what watches them both go by.

    `waits_since_s`: since when it has stood before something; None while it drives. `driving`: a
    drive was begun and has not been stopped since. `fell_short`: so often a drive of this step has
    ended by itself without reaching its goal.
    """

    drives: Sequence[Drive] = ()
    waits_since_s: float | None = None
    fell_short: int = 0
    driving: bool = False

    @property
    def drive(self) -> Drive | None:
        """The step under way; None before the first."""
        return None if self.step == BEFORE_FIRST_STEP else self.drives[self.step - 1]

    @property
    def phase(self) -> Phase:
        """What the step under way is for."""
        if self.state is ExecutionState.CONFIRMING:
            return Phase.CONFIRM
        return Phase.PREPARE if self.drive is None else self.drive.phase
