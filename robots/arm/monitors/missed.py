"""`missed`: the gripper has closed, but not on the object."""

from typing import ClassVar

from mend.robots.arm.behaviors.pick_and_place import PickAndPlace
from mend.robots.arm.grip import GripState
from mend.robots.arm.monitors.grip import GripMonitor
from mend.robots.execution.phase import Phase


class Missed(GripMonitor):
    """Raises `missed` from approach to lift, once the gripper has closed."""

    issue: ClassVar[str] = "missed"
    behaviors: ClassVar[frozenset[str]] = frozenset({PickAndPlace.name})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.APPROACH, Phase.GRASP, Phase.LIFT})
    state: ClassVar[GripState] = GripState.ABSENT
