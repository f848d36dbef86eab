"""Whether nothing in a building changes but the time, and until when that is so."""

import math
from collections.abc import Hashable

from mend.sim.building.carrying import Carrying
from mend.sim.building.crowd import Crowd
from mend.sim.building.doors import WorldDoors
from mend.sim.building.elevator_bank import ElevatorBank
from mend.sim.building.lasers import Lasers


class Stillness:
    """Compares the building of one cycle with that of the next.

    What each cycle makes of it follows from what it is, and from the clock: what one cycle has left
    as it was the next one leaves so, too, until the clock comes to a time at which something is to
    happen.
    """

    def __init__(
        self,
        crowd: Crowd,
        doors: WorldDoors,
        elevators: ElevatorBank,
        lasers: Lasers,
        carrying: Carrying,
    ) -> None:
        self._crowd, self._doors, self._elevators = crowd, doors, elevators
        self._lasers, self._carrying = lasers, carrying
        self._before: tuple[int, Hashable] | None = None

    def disturb(self) -> None:
        """Somebody has done something: one more cycle has to show what comes of it."""
        self._before = None

    def skip(self, cycles: int) -> None:
        """So many cycles have passed at once, as nothing changes."""
        if self._before is not None:
            cycle, state = self._before
            self._before = cycle + cycles, state

    def ends_s(self, cycle: int, time_s: float) -> float:
        """Until when nothing changes; called once in each of several cycles, or it is not known.

        `cycle`: how many have passed; the answer is `time_s` where something may change now.
        """
        state = self._state()
        before, self._before = self._before, (cycle, state)
        if before != (cycle - 1, state) or any(each.moving for each in self._crowd.robots):
            return time_s
        due_s = self._carrying.due_s
        return min(
            self._doors.changes_s(time_s),
            self._elevators.changes_s(time_s),
            self._crowd.walkers.changes_s(time_s),
            self._crowd.guests.changes_s(time_s),
            self._lasers.needed_s(),
            math.inf if due_s is None else due_s,
        )

    def _state(self) -> Hashable:
        return (
            tuple(each.at for each in self._crowd.robots),
            tuple(each.is_shut for each in self._doors.values()),
            self._elevators.state(),
            self._crowd.guests.state(),
        )
