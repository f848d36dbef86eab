"""How far a base's execution has come."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from mend.robots.base.behaviors.behavior import (
    BaseStep,
    StandingStep,
    phase_of,
)
from mend.robots.base.ways import Ride
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP
from mend.robots.execution.phase import Phase
from mend.robots.execution.progress import Progress


@dataclass(slots=True)
class Wait:
    """Waiting for a ride to begin, or `aboard` for its end, since `since_s` of the world's clock.

    `was_shut`: whether the cabin was seen shut meanwhile.
    """

    ride: Ride
    aboard: bool
    since_s: float
    was_shut: bool = False


@dataclass(frozen=True, slots=True)
class StandingWait:
    """Standing at a place for what people are to do, since `since_s` of the world's clock."""

    step: StandingStep
    since_s: float


@dataclass(slots=True, kw_only=True)
class BaseProgress(Progress):
    """What walks the steps and what watches them both go by.

    `blocked_since_s`: since when it has stood before something; None while it drives. `stalled_s`:
    how long it has come no nearer, although it may move. `no_way`: why it knows no way. `wait`: for
    what elevator it waits, and `standing` for what people. `heard`: somebody has said that the
    message was heard. `awaits_s`: since when it has waited for elevators that have not come.
    `alone_since_s`: since when it has waited for whom it leads. `ran_low`: its battery was low, and
    it has not been charged enough since.
    """

    steps: Sequence[BaseStep] = ()
    blocked_since_s: float | None = None
    stalled_s: float = 0.0
    no_way: str | None = None
    wait: Wait | None = None
    standing: StandingWait | None = None
    heard: bool = False
    awaits_s: dict[str, float] = field(default_factory=dict)
    alone_since_s: float | None = None
    ran_low: bool = False

    @property
    def taken(self) -> BaseStep | None:
        """The step under way; None before the first."""
        return None if self.step == BEFORE_FIRST_STEP else self.steps[self.step - 1]

    @property
    def phase(self) -> Phase:
        """What the step under way is for."""
        if self.state is ExecutionState.CONFIRMING:
            return Phase.CONFIRM
        if self.taken is None:
            return Phase.PREPARE
        if self.wait is not None:
            return Phase.RIDE
        # Who gets into a cabin drives: what is in its way there is in its way as anywhere.
        phase = phase_of(self.taken)
        return Phase.TRAVEL if phase is Phase.RIDE else phase
