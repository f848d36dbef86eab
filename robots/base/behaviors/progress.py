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

    `waits_since_s`: since when it has stood before something; None while it drives. `stalled_s`:
    how long it has come no nearer, although it may move. `no_way`: why it knows no way.
    """

    drives: Sequence[Drive] = ()
    waits_since_s: float | None = None
    stalled_s: float = 0.0
    no_way: str | None = None

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
