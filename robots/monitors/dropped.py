"""`dropped`: the object was between the fingers, and is not any more."""

from typing import ClassVar

from robots.link.messages import Detection
from robots.monitors.grip_detection import describe_grip
from robots.monitors.monitor import Meanwhile, Monitor, MonitorView
from robots.vision.forearm import GripState
from tasks.scene import StrictModel


class DroppedParameters(StrictModel):
    """It has none."""


class Dropped(Monitor[DroppedParameters]):
    """Raises `dropped` in steps 4 and 5, at any moment."""

    issue: ClassVar[str] = "dropped"
    start_step: ClassVar[int] = 4
    stop_step: ClassVar[int] = 5
    meanwhile: ClassVar[Meanwhile] = Meanwhile.GO_TO_NEUTRAL
    camera: ClassVar[str | None] = "forearm"
    parameters: ClassVar[type[StrictModel]] = DroppedParameters

    def check(self, view: MonitorView) -> Detection | None:
        if view.grip is None or view.grip.state is not GripState.LOST:
            return None
        return describe_grip(view.grip, "is no longer")
