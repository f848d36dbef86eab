"""`missed`: the gripper has closed, but not on the object."""

from typing import ClassVar

from robots.monitors.grip import GripMonitor
from robots.vision.forearm import GripState


class Missed(GripMonitor):
    """Raises `missed` in steps 1 to 4, once the gripper has closed."""

    issue: ClassVar[str] = "missed"
    start_step: ClassVar[int] = 1
    stop_step: ClassVar[int] = 4
    state: ClassVar[GripState] = GripState.ABSENT
    how: ClassVar[str] = "never was"
