"""The monitors of one execution: what they are shown, and what they report."""

import math
from collections.abc import Sequence
from typing import Any, NoReturn

from mend.errors import IllegalTransitionError
from mend.robots.arm.behaviors.behavior import SetGripper
from mend.robots.arm.behaviors.contact import Contact, Try
from mend.robots.arm.behaviors.phase import Phase
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.grip import GripReading
from mend.robots.arm.monitors.monitor import Monitor, MonitorView
from mend.robots.arm.perception import FOREARM, HEAD
from mend.robots.link.messages import Detection, IssueDetected
from mend.robots.vision.drawing import draw_detection, encode_jpeg

_CAREFUL = 0.5
"""While a person's hands are near, motion is scaled by this."""


class Interruption(Exception):  # noqa: N818 - control flow, not an error
    """A monitor's issue ends the walk through the steps."""

    def __init__(self, monitor: Monitor[Any]) -> None:
        super().__init__(monitor.issue)
        self.monitor = monitor


class Watch:
    """Lets the monitors of the step under way judge what is seen and felt."""

    def __init__(self, work: Work, monitors: Sequence[Monitor[Any]]) -> None:
        self._work = work
        self._progress = work.progress
        self._monitors = monitors
        self._raised: set[str] = set()
        self._forces_n: list[float] = []
        self._next_check_s = -math.inf
        self._read_s = -math.inf

    def tries(self, phase: Phase) -> Sequence[Try]:
        """The tries of the first monitor of a phase to which it matters what is felt."""
        return next((each.tries for each in self._watching(phase) if each.tries), ())

    def note_force(self, force_n: float) -> None:
        """The arm felt this; it is shown at the next check."""
        self._forces_n.append(force_n)

    def start_again(self) -> None:
        """What did not interrupt the steps may be reported again."""
        self._raised.clear()

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
        for monitor in self._watching(self._progress.phase):
            if monitor.issue in self._raised:
                continue
            if view.blind is not None and monitor.camera == HEAD:
                continue
            detection = monitor.check(view)
            if detection is None:
                continue
            if monitor.interrupts:
                self._work.arm.stop()
            else:
                self._raised.add(monitor.issue)
                self._work.arm.be_careful(_CAREFUL)
            self._report_issue(monitor, detection, view)
            if monitor.interrupts:
                raise Interruption(monitor)

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
        return any(each.camera == FOREARM for each in self._watching(phase))

    def _watching(self, phase: Phase) -> list[Monitor[Any]]:
        name = self._work.assignment.behavior.monitored_as
        return [each for each in self._monitors if each.watches(name, phase)]

    def _closing(self) -> bool:
        """Whether the fingers are still on their way together."""
        plan = self._progress.plan
        if plan is None or not self._work.arm.body.moving:
            return False
        return plan.steps[self._progress.step - 1].action == SetGripper("closed")

    def _view(self, grip: GripReading | None) -> MonitorView:
        progress = self._progress
        pictures, outcome = {}, progress.outcome
        seen = progress.seen if outcome is None else outcome
        if seen.image is not None:
            pictures[HEAD] = seen.image
        if grip is not None:
            pictures[FOREARM] = grip.image
        return MonitorView(
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

    def _report_issue(self, monitor: Monitor[Any], detection: Detection, view: MonitorView) -> None:
        image = view.pictures.get(detection.camera)
        fresh = view.phase in (Phase.PREPARE, Phase.CONFIRM)
        if image is None or (detection.camera == HEAD and not fresh):
            image = self._work.arm.body.cameras[detection.camera].capture()
        height, width = image.bgr.shape[:2]
        detection = detection.model_copy(update={"size_px": (width, height)})
        self._work.report(
            IssueDetected(
                execution=self._work.assignment.execution,
                issue=monitor.issue,
                step=view.step,
                interrupts=monitor.interrupts,
                detection=detection,
                jpeg=encode_jpeg(draw_detection(image.bgr, detection)),
            )
        )
