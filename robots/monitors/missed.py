"""`missed`: the gripper has closed, but not on the object."""

from typing import ClassVar

from robots.link.messages import Detection
from robots.monitors.grip_detection import describe_grip
from robots.monitors.monitor import Meanwhile, Monitor, MonitorView
from robots.vision.forearm import GripState
from tasks.scene import StrictModel


class MissedParameters(StrictModel):
    """It has none."""


class Missed(Monitor[MissedParameters]):
    """Raises `missed` in steps 1 to 4, once the gripper has closed."""

    issue: ClassVar[str] = "missed"
    start_step: ClassVar[int] = 1
    stop_step: ClassVar[int] = 4
    meanwhile: ClassVar[Meanwhile] = Meanwhile.GO_TO_NEUTRAL
    camera: ClassVar[str | None] = "forearm"
    parameters: ClassVar[type[StrictModel]] = MissedParameters

    def check(self, view: MonitorView) -> Detection | None:
        if view.grip is None or view.grip.state is not GripState.ABSENT:
            return None
        return describe_grip(view.grip, "never was")
