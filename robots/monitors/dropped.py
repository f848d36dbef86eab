"""`dropped`: the object was between the fingers, and is not any more."""

from typing import ClassVar

from robots.monitors.grip import GripMonitor
from robots.vision.forearm import GripState


class Dropped(GripMonitor):
    """Raises `dropped` in steps 4 and 5, at any moment."""

    issue: ClassVar[str] = "dropped"
    start_step: ClassVar[int] = 4
    stop_step: ClassVar[int] = 5
    state: ClassVar[GripState] = GripState.LOST
    how: ClassVar[str] = "is no longer"
