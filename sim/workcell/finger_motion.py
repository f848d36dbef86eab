"""Opening and closing: where the fingers are commanded to, cycle by cycle."""

from mend.sim.workcell.gripper import FINGERS_OPEN_RAD

_GRIPPER_CYCLES = 120
_GRIPPER_RAMP_CYCLES = 60
"""The fingers' target moves during the ramp; the rest of the time lets the grasp settle."""


class FingerMotion:
    """Where the fingers are commanded to: a ramp, then a while to let the grasp settle."""

    def __init__(self) -> None:
        self.target_rad = FINGERS_OPEN_RAD
        self._from_rad = FINGERS_OPEN_RAD
        self._to_rad = FINGERS_OPEN_RAD
        self._closing = False
        self._cycle = _GRIPPER_CYCLES

    @property
    def moving(self) -> bool:
        return self._cycle < _GRIPPER_CYCLES

    @property
    def progress(self) -> float:
        return self._cycle / _GRIPPER_CYCLES

    @property
    def closing(self) -> bool:
        """Whether the fingers are closed, on something or not, or on their way together."""
        return self._closing

    def open_to(self, angle_rad: float) -> None:
        self._move_to(angle_rad)
        self._closing = False

    def close(self) -> None:
        self._move_to(0.0)
        self._closing = True

    def stop(self) -> None:
        """Hold the fingers where they are commanded to now; a grasp keeps its force."""
        self._to_rad = self.target_rad
        self._cycle = _GRIPPER_CYCLES

    def advance(self) -> None:
        if self.moving:
            self._cycle += 1
            done = min(1.0, self._cycle / _GRIPPER_RAMP_CYCLES)
            self.target_rad = self._from_rad + (self._to_rad - self._from_rad) * done

    def _move_to(self, angle_rad: float) -> None:
        self._from_rad, self._to_rad = self.target_rad, angle_rad
        self._cycle = 0
