"""`missing`: the object is nowhere in the head picture."""

from typing import ClassVar

from robots.link.messages import Detection
from robots.monitors.monitor import BEFORE_FIRST_STEP, Meanwhile, Monitor, MonitorView
from tasks.scene import StrictModel


class MissingParameters(StrictModel):
    """It has none."""


class Missing(Monitor[MissingParameters]):
    """Raises `missing` before step 1."""

    issue: ClassVar[str] = "missing"
    start_step: ClassVar[int] = BEFORE_FIRST_STEP
    stop_step: ClassVar[int] = BEFORE_FIRST_STEP
    meanwhile: ClassVar[Meanwhile] = Meanwhile.DO_NOT_START
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = MissingParameters

    def check(self, view: MonitorView) -> Detection | None:
        if view.part is None or view.sighting is not None or view.grip is not None:
            return None
        return Detection(
            camera="head", explanation=f"{view.part.name} is nowhere in the head picture"
        )
