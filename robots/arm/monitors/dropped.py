"""`dropped`: the object was between the fingers, and is not any more."""

from typing import ClassVar

from mend.robots.arm.behaviors.pick_and_place import PickAndPlace
from mend.robots.arm.grip import GripState
from mend.robots.arm.monitors.grip import GripMonitor
from mend.robots.execution.phase import Phase


class Dropped(GripMonitor):
    """Raises `dropped` while lifting and carrying, at any moment."""

    issue: ClassVar[str] = "dropped"
    behaviors: ClassVar[frozenset[str]] = frozenset({PickAndPlace.name})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.LIFT, Phase.CARRY})
    state: ClassVar[GripState] = GripState.LOST
