"""`positioning`: the object is one that a person has to help place."""

from typing import ClassVar

from robots.link.messages import Detection
from robots.monitors.monitor import Meanwhile, Monitor, MonitorView, NoParameters
from tasks.scene import StrictModel


class Positioning(Monitor[NoParameters]):
    """Raises `positioning` at step 5; the robot goes on slowly."""

    issue: ClassVar[str] = "positioning"
    start_step: ClassVar[int] = 5
    stop_step: ClassVar[int] = 5
    meanwhile: ClassVar[Meanwhile] = Meanwhile.SLOW_DOWN
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: MonitorView) -> Detection | None:
        if not view.needs_help or view.part is None:
            return None
        return Detection(
            camera="forearm", explanation=f"{view.part.name} is one that needs help with placing"
        )
