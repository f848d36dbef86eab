"""What `missed` and `dropped` share: the object is not where it must be in the forearm picture."""

from typing import ClassVar

from robots.link.messages import Detection
from robots.monitors.monitor import Meanwhile, Monitor, MonitorView, NoParameters
from robots.vision.forearm import GripState
from tasks.scene import StrictModel


class GripMonitor(Monitor[NoParameters]):
    """Raises its issue once the pictures show the grip in `state`; `how` says so in words."""

    state: ClassVar[GripState]
    how: ClassVar[str]
    meanwhile: ClassVar[Meanwhile] = Meanwhile.GO_TO_NEUTRAL
    camera: ClassVar[str | None] = "forearm"
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: MonitorView) -> Detection | None:
        grip = view.grip
        if grip is None or grip.state is not self.state:
            return None
        return Detection(
            camera="forearm",
            center=None if grip.blob is None else grip.blob.center,
            expected=grip.expected,
            tolerance_px=grip.tolerance_px,
            area_px=0 if grip.blob is None else grip.blob.area_px,
            explanation=f"{grip.name} {self.how} where it must be between the fingers",
        )
