"""One motion of the arm towards a pose, felt all the way."""

from collections.abc import Sequence

from mend.robots.arm.arm import Arm
from mend.robots.arm.behaviors.contact import ContactWatch, Track, hindering_n, is_arrival
from mend.robots.arm.body import ToolPose


class FeltMotion:
    """Feels a motion to `to`, stops it where something pushes lastingly, and knows the way back."""

    def __init__(self, arm: Arm, to: ToolPose, limit_n: float) -> None:
        self._arm, self._to = arm, to
        self._track, self._contact = Track(), ContactWatch(limit_n)

    @property
    def strongest_n(self) -> float:
        return self._contact.strongest_n

    def way_back(self) -> Sequence[ToolPose]:
        """The poses passed last, the latest first."""
        return self._track.way_back()

    def is_held_up(self) -> bool:
        """Take one reading, and stop at a contact; whether that is short of where it was to end."""
        body, here = self._arm.body, self._arm.tool_pose()
        self._track.note(here)
        force = body.contact_force()
        strength_n = body.contact_force_n() if here is None else hindering_n(force, here, self._to)
        if not self._contact.feel(strength_n, body.control_period_s):
            return False
        self._arm.stop()
        return here is None or not is_arrival(here, self._to)
