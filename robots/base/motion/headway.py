"""Whether a base comes nearer to the end of its way, or only moves."""

import math

_NEARER_M = 0.02
_NEARER_RAD = 0.02


class Headway:
    """How long one drive has come no nearer: in time in which it might have."""

    def __init__(self, turn_rad_s: float) -> None:
        """Who turns `turn_rad_s` at best is given time for one whole turn each time."""
        self._turn_s = math.tau / turn_rad_s
        self._least_m, self._least_rad = math.inf, math.inf
        self._since_s = 0.0

    def note(self, left_m: float, turn_rad: float | None, passed_s: float) -> None:
        """So much of the way is left, and to turn at its end (None before that).

        `passed_s` have passed, or rather less for a base that goes slowly on purpose.
        """
        self._since_s += passed_s
        if left_m < self._least_m - _NEARER_M:
            self._least_m, self._since_s = left_m, 0.0
        if turn_rad is not None and turn_rad < self._least_rad - _NEARER_RAD:
            self._least_rad, self._since_s = turn_rad, 0.0

    @property
    def stalled_s(self) -> float:
        """How long it has come no nearer."""
        return max(0.0, self._since_s - self._turn_s)
