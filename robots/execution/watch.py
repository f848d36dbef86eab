"""The monitors of one execution: which of them judge, and what becomes of what they detect."""

from abc import ABC
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

from mend.errors import MendError
from mend.robots.body import CameraImage
from mend.robots.execution.effector import Effector
from mend.robots.execution.monitor import AnyMonitor, MonitorView, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.execution.progress import G
from mend.robots.link.messages import Detection, IssueDetected, ReportBody
from mend.robots.vision.drawing import draw_detection, encode_jpeg

_CAREFUL = 0.5
"""While a person is near, motion is scaled by this."""

V = TypeVar("V", bound=MonitorView)


class Interruption(Exception):  # noqa: N818 - control flow, not an error
    """Something ends the walk through the steps: the robot reacts, and holds."""

    def __init__(self, reaction: Reaction, issue: str) -> None:
        super().__init__(issue)
        self.reaction, self.issue = reaction, issue


class MonitorFailedError(MendError):
    """A monitor of somebody's has raised an error: what it watches for would go unnoticed."""

    def __init__(self, issue: str, error: Exception) -> None:
        super().__init__(
            f"its monitor for '{issue}' failed ({type(error).__name__}: {error}), and without one "
            "of its monitors it does nothing"
        )


class Watch(ABC, Generic[V, G]):
    """Lets the monitors of the step under way judge what is sensed."""

    def __init__(
        self,
        execution: str,
        behavior: str,
        progress: G,
        effector: Effector[Any],
        monitors: Sequence[AnyMonitor],
        report: Callable[[ReportBody], None],
    ) -> None:
        """`behavior`: the name by which monitors know the one that is executed."""
        self._execution, self._behavior = execution, behavior
        self._progress, self._effector = progress, effector
        self._monitors = monitors
        self._report = report
        self._raised: set[str] = set()

    def start_again(self) -> None:
        """What did not interrupt the steps may be reported again."""
        self._raised.clear()

    def watching(self, phase: Phase) -> list[AnyMonitor]:
        """The monitors that check in a phase."""
        return [each for each in self._monitors if each.watches(self._behavior, phase)]

    def show(self, view: V) -> None:
        """Let the monitors of this step judge. Raises `Interruption` for the first that must.

        Raises `MonitorFailedError` where one of them cannot.
        """
        for monitor in self.watching(self._progress.phase):
            if monitor.issue in self._raised or not self._may_judge(monitor, view):
                continue
            detection = _checked(monitor, view)
            if detection is None or self._copes_with(monitor, detection):
                continue
            if monitor.interrupts:
                self._effector.stop()
            else:
                self._raised.add(monitor.issue)
                self._effector.be_careful(_CAREFUL)
            self._report_issue(monitor, detection, view)
            if monitor.interrupts:
                raise Interruption(monitor.reaction, monitor.issue)

    def _copes_with(self, _: AnyMonitor, __: Detection) -> bool:
        """Whether the robot deals with it by itself, so that it is no issue."""
        return False

    def _may_judge(self, _: AnyMonitor, __: V) -> bool:
        """Whether a monitor can judge by what it is shown."""
        return True

    def _picture(self, camera: str, view: V) -> CameraImage | None:
        """The picture that goes with a detection; None where there is no such camera."""
        image = view.pictures.get(camera)
        if image is None and camera in self._effector.body.cameras:
            image = self._effector.body.cameras[camera].capture()
        return image

    def _report_issue(self, monitor: AnyMonitor, detection: Detection, view: V) -> None:
        image, jpeg = self._picture(detection.camera, view), None
        if image is not None:
            height, width = image.bgr.shape[:2]
            detection = detection.model_copy(update={"size_px": (width, height)})
            jpeg = encode_jpeg(draw_detection(image.bgr, detection))
        self._report(
            IssueDetected(
                execution=self._execution,
                issue=monitor.issue,
                step=view.step,
                interrupts=monitor.interrupts,
                detection=detection,
                jpeg=jpeg,
            )
        )


def _checked(monitor: AnyMonitor, view: MonitorView) -> Detection | None:
    try:
        return monitor.check(view)
    except Exception as error:
        raise MonitorFailedError(monitor.issue, error) from error
