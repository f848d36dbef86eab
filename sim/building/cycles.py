"""The clock of a building: control cycles, so that many at once are as many one by one."""

import math

from mend.sim.building.building_robot import PERIOD_S

_EPSILON_S = 1e-9


class Cycles:
    """How many control cycles have passed."""

    def __init__(self) -> None:
        self.passed = 0

    def time_s(self) -> float:
        """Seconds since the building's beginning."""
        return self.passed * PERIOD_S

    def set_s(self, time_s: float) -> None:
        """Go on from a time that it showed before."""
        self.passed = round(time_s / PERIOD_S)

    def before(self, time_s: float) -> int:
        """How many more cycles end before a time; 0 where the next one reaches it."""
        if time_s <= self.time_s():
            return 0
        return max(0, math.ceil((time_s - _EPSILON_S) / PERIOD_S) - 1 - self.passed)
