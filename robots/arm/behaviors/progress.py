"""How far an arm's execution has come, and what was planned and seen for it."""

from dataclasses import dataclass, field

from mend.errors import IllegalTransitionError
from mend.robots.arm.behaviors.contact import Contact
from mend.robots.arm.behaviors.findings import Findings, Outcome
from mend.robots.arm.behaviors.planning import Plan, waypoints_of
from mend.robots.arm.body import ToolPose
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP
from mend.robots.execution.phase import Phase
from mend.robots.execution.progress import Progress
from mend.robots.link.messages import WasDone


@dataclass(slots=True, kw_only=True)
class ArmProgress(Progress):
    """What walks the steps of an arm and what watches them both go by.

    `contact` is what the monitors are to judge,
    `felt` what the empty hand felt last on its way to the object. `as_found`: neither the robot nor
    anybody whom it asked has done anything to it; `inexact`: the object is at its place, but so far
    off that it is to be placed better; `unconfirmed`: it was let go of there, and nothing could be
    seen. `regrasps`: so often it was let go of, as
    something had pushed it askew, to be grasped anew. `picked_at` is the tool pose at which what is
    held was picked up, None if a person handed it over. `object_at` is where the service has the
    object (base frame), None if it may be anywhere; `told_at` where it was last told to be seen.
    """

    was_done: WasDone | None
    object_at: tuple[float, float] | None = None
    told_at: tuple[float, float] | None = None
    plan: Plan | None = None
    seen: Findings = field(default_factory=Findings)
    outcome: Outcome | None = None
    contact: Contact | None = None
    felt: Contact | None = None
    as_found: bool = True
    inexact: bool = False
    unconfirmed: bool = False
    regrasps: int = 0
    picked_at: ToolPose | None = None

    def start_again(self) -> None:
        """Forget what was planned and seen: the first step is still to come."""
        self.step, self.plan, self.seen = BEFORE_FIRST_STEP, None, Findings()
        self.outcome = self.contact = None

    @property
    def planned(self) -> Plan:
        """The plan that is walked. Raises `IllegalTransitionError` before there is one."""
        if self.plan is None:
            raise IllegalTransitionError("the execution", self.state, "none", "a plan")
        return self.plan

    @property
    def phase(self) -> Phase:
        """What the step under way is for."""
        if self.state is ExecutionState.CONFIRMING:
            return Phase.CONFIRM
        if self.plan is None or self.step == BEFORE_FIRST_STEP:
            return Phase.PREPARE
        phase = self.plan.steps[self.step - 1].phase
        if self.state is ExecutionState.BACKING_OFF and phase is Phase.PLACE:
            # What it was about to put down it carries again, unless that was taken from it.
            return Phase.CARRY
        return phase

    @property
    def way(self) -> list[ToolPose]:
        """The poses that the steps still to come lead through, or would if there were a path."""
        if self.outcome is not None:
            return []
        if self.plan is None:
            return list(self.seen.way)
        return waypoints_of(self.plan.steps[max(self.step, self.plan.first) - 1 :])
