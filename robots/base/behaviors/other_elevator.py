"""Taking another elevator where one does not come, or others are to ride in it before."""

import math
from collections.abc import Callable, Sequence

from mend.robots.base.base import Base
from mend.robots.base.behaviors.behavior import (
    BaseStep,
    Drive,
    GetIn,
    RideUntilThere,
    steps_of_ride,
)
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.ways import Ride
from mend.robots.execution.command_error import CommandError
from mend.robots.link.messages import ReportBody, WayFound

DEAD_S = 240.0
"""An elevator that has taken nobody along for so long counts as dead: the busiest do sooner."""
GIVEN_UP_S = 60.0
"""So does one for which people were asked so long in vain that what was to be done is given up."""


class OtherElevator:
    """Lays the rest of a journey out anew; what it has found is reported."""

    def __init__(
        self, base: Base, progress: BaseProgress, report: Callable[[ReportBody], None]
    ) -> None:
        self._base, self._progress, self._report = base, progress, report
        self._looks_s = -math.inf

    def awaits(self, ride: Ride) -> None:
        """It waits for an elevator, or still does."""
        self._progress.awaits_s.setdefault(ride.elevator, self._base.body.time_s())

    def took(self, ride: Ride) -> None:
        """That has taken it to where it wanted to go."""
        self._progress.awaits_s.pop(ride.elevator, None)
        if self._base.rode(ride.between):
            self._report(WayFound(finding="open", between=list(ride.between)))

    def leads_there(self, step: GetIn) -> bool:
        """Whether an elevator counts as dead or closed, or is wanted by others before, and another
        one rides where it is to go, or does so sooner.

        That is found out once a second at most.
        """
        now_s = self._base.body.time_s()
        if now_s < self._looks_s or not (self._is_dead(step.ride) or self._is_busy(step)):
            return False
        self._looks_s = now_s + 1.0
        return bool(self._rest(step))

    def take(self, step: GetIn) -> bool:
        """Go to another one from here, if that leads there; whether it does."""
        is_dead = self._is_dead(step.ride)
        steps = self._rest(step) if is_dead or self._is_busy(step) else ()
        if not steps:
            return False
        if is_dead:
            self._note_dead(step.ride)
        self._lay_out(step.ride, steps)
        return True

    def from_here(self, step: RideUntilThere) -> bool:
        """Go on from where somebody has put it who has carried it out of the cabin; whether
        anything leads to where it is to go from there."""
        left, arrives = self._left()
        if arrives is None:
            return False
        drive = left[arrives]
        assert isinstance(drive, Drive), "a journey ends with one"
        try:
            rides = self._base.rides_from_here(drive.to)
        except CommandError:
            return False
        again = [each for ride in rides for each in steps_of_ride(ride, step.leads)]
        self._lay_out(step.ride, [*again, *left[arrives:]])
        return True

    def _lay_out(self, ride: Ride, steps: Sequence[BaseStep]) -> None:
        """Take these steps from here on, and not that ride."""
        self._progress.awaits_s.pop(ride.elevator, None)
        done = self._progress.steps[: self._progress.step - 1]
        self._progress.steps = [*done, *steps]
        self._base.elevators.withdraw()
        self.announce(steps)

    def announce(self, steps: Sequence[BaseStep]) -> None:
        """Say to which elevator it is on its way next, if to any."""
        ahead = next((each for each in steps if isinstance(each, GetIn | RideUntilThere)), None)
        if isinstance(ahead, GetIn):
            self._base.elevators.heads_for(ahead.ride.elevator)

    def give_up(self) -> None:
        """What it waits for is given up: it asked for an elevator in vain."""
        taken = self._progress.taken
        if isinstance(taken, GetIn) and self._waited_s(taken.ride) >= GIVEN_UP_S:
            self._note_dead(taken.ride)

    def _note_dead(self, ride: Ride) -> None:
        self._progress.awaits_s.pop(ride.elevator, None)
        if not self._base.is_closed(ride):
            self._base.bar(ride.between)
            self._report(WayFound(finding="elevator_dead", between=list(ride.between)))

    def _is_dead(self, ride: Ride) -> bool:
        return self._waited_s(ride) >= DEAD_S or self._base.is_closed(ride)

    def _is_busy(self, step: GetIn) -> bool:
        """Whether others are to ride before it; with whom it leads it stays."""
        ahead_s = self._base.elevators.waits_s().get(step.ride.elevator, 0.0)
        return step.leads is None and ahead_s > 0.0

    def _waited_s(self, ride: Ride) -> float:
        now_s = self._base.body.time_s()
        return now_s - self._progress.awaits_s.get(ride.elevator, now_s)

    def _rest(self, step: GetIn) -> Sequence[BaseStep]:
        """What is left to do if others ride to where this journey ends; nothing if none do."""
        left, arrives = self._left()
        if arrives is None:
            return ()
        drive = left[arrives]
        assert isinstance(drive, Drive), "a journey ends with one"
        dead = self._is_dead(step.ride)
        others = self._base.rides_round if dead else self._base.rides_sooner
        try:
            rides = others(step.ride, drive.to)
        except CommandError:
            return ()
        again = [each for ride in rides for each in steps_of_ride(ride, step.leads)]
        return [*again, *left[arrives:]] if rides else ()

    def _left(self) -> tuple[Sequence[BaseStep], int | None]:
        """The step under way and those after it, and which of them ends the journey."""
        left = self._progress.steps[self._progress.step - 1 :]
        return left, next((n for n, _ in enumerate(left) if _ends_journey(left, n)), None)


def _ends_journey(steps: Sequence[BaseStep], number: int) -> bool:
    """Whether a step drives from the last elevator to where it is to go."""
    if number == 0 or not isinstance(steps[number], Drive):
        return False
    following = steps[number + 1] if number + 1 < len(steps) else None
    return isinstance(steps[number - 1], RideUntilThere) and not isinstance(following, GetIn)
