"""The clock of a workcell, which all its robots share."""

from dataclasses import dataclass

from mend.sim.workcell.physics import CONTROL_HZ

PERIOD_S = 1.0 / CONTROL_HZ


@dataclass(slots=True)
class Clock:
    """Counts control cycles."""

    cycle: int = 0

    def time_s(self) -> float:
        return self.cycle * PERIOD_S
