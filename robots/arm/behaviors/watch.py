"""The monitors of an arm's execution: when they check, and what they are shown."""

import math
from collections.abc import Sequence
from typing import NoReturn

from mend.errors import IllegalTransitionError
from mend.robots.arm.behaviors.behavior import SetGripper
from mend.robots.arm.behaviors.contact import Contact, Try
from mend.robots.arm.behaviors.progress import ArmProgress
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.grip import GripReading
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.arm.perception import FOREARM, HEAD
from mend.robots.body import CameraImage
from mend.robots.execution.monitor import AnyMonitor
from mend.robots.execution.phase import Phase
from mend.robots.execution.watch import Watch


class ArmWatch(Watch[ArmView, ArmProgress]):
    """Lets the monitors of the step under way judge what is seen and felt."""

    def __init__(self, work: Work, monitors: Sequence[AnyMonitor]) -> None:
        assignment = work.assignment
        super().__init__(
            assignment.execution,
            assignment.behavior.monitored_as,
            work.progress,
            work.arm,
            monitors,
            work.report,
        )
        self._work = work
        self._forces_n: list[float] = []
        self._next_check_s = -math.inf
        self._read_s = -math.inf

    def tries(self, phase: Phase) -> Sequence[Try]:
        """The tries of the first monitor of a phase to which it matters what is felt."""
        arms = (each for each in self.watching(phase) if isinstance(each, ArmMonitor))
        return next((each.tries for each in arms if each.tries), ())

    def note_force(self, force_n: float) -> None:
        """The arm felt this; it is shown at the next check."""
        self._forces_n.append(force_n)

    def check_if_due(self) -> None:
        """Check at the forearm camera's period. Raises `Interruption`."""
        now = self._work.arm.body.time_s()
        if now < self._next_check_s - 1e-9:
            return
        self._next_check_s = now + self._work.perception.hand.period_s
        looking = self._judges_grip(self._progress.phase) and not self._closing()
        self._read_s = now if looking else self._read_s
        self.check(self._work.perception.read_grip() if looking else None)

    def check(self, grip: GripReading | None) -> None:
        """Let the monitors of this step judge. Raises `Interruption` for the first that must."""
        view = self._view(grip)
        self._forces_n.clear()
        self.show(view)

    def judge(self, contact: Contact) -> NoReturn:
        """Let the monitors judge what was felt. Raises `Interruption`."""
        self._progress.contact = contact
        self.check(None)
        expected = f"an issue of {contact.force_n:.0f} N against the arm"
        raise IllegalTransitionError("the execution", self._progress.state, "none", expected)

    def grip_is_open_question(self, arrived_s: float) -> bool:
        """Whether the pictures have yet to show what the gripper holds.

        The last step in which they are looked at ends with one taken after the arm has arrived.
        """
        grip, plan = self._work.perception.hand.grip, self._progress.plan
        if grip is None or plan is None or not self._judges_grip(self._progress.phase):
            return False
        following = plan.steps[self._progress.step : self._progress.step + 1]
        if following and self._judges_grip(following[0].phase):
            return grip.in_doubt
        return grip.in_doubt or self._read_s < arrived_s

    def _judges_grip(self, phase: Phase) -> bool:
        return any(each.camera == FOREARM for each in self.watching(phase))

    def _closing(self) -> bool:
        """Whether the fingers are still on their way together."""
        plan = self._progress.plan
        if plan is None or not self._work.arm.body.moving:
            return False
        return plan.steps[self._progress.step - 1].action == SetGripper("closed")

    def _view(self, grip: GripReading | None) -> ArmView:
        progress = self._progress
        pictures, outcome = {}, progress.outcome
        seen = progress.seen if outcome is None else outcome
        if seen.image is not None:
            pictures[HEAD] = seen.image
        if grip is not None:
            pictures[FOREARM] = grip.image
        return ArmView(
            time_s=self._work.arm.body.time_s(),
            step=progress.step,
            phase=progress.phase,
            part=self._work.assignment.part,
            needs_help=self._work.assignment.needs_help,
            target=self._work.assignment.target,
            was_done=progress.was_done,
            reach=self._work.arm.body.reach,
            table_z=self._work.perception.catalogue.table.height,
            sighting=progress.seen.sighting,
            refusal=progress.seen.refusal,
            obstruction=progress.seen.obstruction,
            blind=progress.seen.blind if outcome is None else outcome.blind,
            grip=grip,
            placed=None if outcome is None else outcome.sighting,
            presence=None if outcome is None else outcome.presence,
            contact=progress.contact,
            contact_forces_n=tuple(self._forces_n),
            pictures=pictures,
        )

    def _may_judge(self, monitor: AnyMonitor, view: ArmView) -> bool:
        return view.blind is None or monitor.camera != HEAD

    def _picture(self, camera: str, view: ArmView) -> CameraImage | None:
        image = view.pictures.get(camera)
        fresh = view.phase in (Phase.PREPARE, Phase.CONFIRM)
        if image is None or (camera == HEAD and not fresh):
            image = self._work.arm.body.cameras[camera].capture()
        return image
