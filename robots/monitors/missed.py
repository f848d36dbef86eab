"""`missed`: the gripper has closed, but not on the object."""

from typing import ClassVar

from mend.robots.behaviors.phase import Phase
from mend.robots.behaviors.pick_and_place import PickAndPlace
from mend.robots.grip import GripState
from mend.robots.monitors.grip import GripMonitor


class Missed(GripMonitor):
    """Raises `missed` from approach to lift, once the gripper has closed."""

    issue: ClassVar[str] = "missed"
    behaviors: ClassVar[frozenset[str]] = frozenset({PickAndPlace.name})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.APPROACH, Phase.GRASP, Phase.LIFT})
    state: ClassVar[GripState] = GripState.ABSENT
