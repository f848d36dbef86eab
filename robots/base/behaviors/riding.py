"""Riding elevators: waiting for one, getting in, and staying in it until it is there."""

from collections.abc import Callable

from mend.maps.building.cabin import CABIN_M
from mend.robots.base.base import Base
from mend.robots.base.behaviors.behavior import Drive, GetIn, RideUntilThere
from mend.robots.base.behaviors.driving import Driving
from mend.robots.base.behaviors.other_elevator import OtherElevator
from mend.robots.base.behaviors.progress import BaseProgress, Wait
from mend.robots.base.behaviors.watch import BaseWatch
from mend.robots.base.body import BasePose
from mend.robots.base.companion import IN_CABIN_M
from mend.robots.base.ways import Ride
from mend.robots.execution.routine import Routine

_GETS_OUT_S = 60.0


def place_in(step: GetIn) -> BasePose:
    """Where in the cabin the base is to be."""
    ride = step.ride
    return ride.inside if step.leads is None or ride.aside is None else ride.aside


def _has_company(step: GetIn | RideUntilThere) -> bool:
    """Whether somebody is to ride with the base."""
    return step.leads is not None and step.ride.aside is not None


class Riding:
    """Takes the steps of rides, and lets the monitors watch."""

    def __init__(
        self,
        base: Base,
        driving: Driving,
        progress: BaseProgress,
        watch: BaseWatch,
        other: OtherElevator,
    ) -> None:
        self._base, self._driving = base, driving
        self._progress, self._watch = progress, watch
        self._other = other

    def get_in(self, step: GetIn) -> Routine[bool]:
        """Wait until the cabin is open for this robot, and drive in. Raises `Interruption`.

        If it shuts before the robot is in, the robot waits again. False if it does not come, and
        another elevator is taken: what is left to do is another then.
        """
        ride, elevators = step.ride, self._base.elevators

        def is_open_or_leads_elsewhere() -> bool:
            return elevators.is_open_for(ride) or self._other.leads_there(step)

        while not self._is_in(ride):
            self._other.awaits(ride)
            yield from self._await(
                ride,
                aboard=False,
                until=is_open_or_leads_elsewhere,
                stay_open=_has_company(step),
            )
            if not elevators.is_open_for(ride) and self._other.take(step):
                return False
            yield from self._driving.take(
                Drive(step.name, place_in(step)), lambda: not elevators.is_open_for(ride)
            )
        return True

    def ride(self, step: RideUntilThere) -> Routine[bool]:
        """Stay until the cabin is open at the floor where the ride ends. Raises `Interruption`.

        With whom it leads it leaves once they are in it, too, where there is room for both. False
        where somebody has carried it out meanwhile: what is left to do is another then.
        """
        if _has_company(step) and not self.is_over(step.ride):
            yield from self._let_in(step.ride)
        yield from self._await(
            step.ride,
            aboard=True,
            until=lambda: self.is_over(step.ride) or self._is_carried_out(step.ride),
        )
        if not self.is_over(step.ride) and self._other.from_here(step):
            return False
        self._other.took(step.ride)
        # It may have asked once more between its arrival and the scan that shows it.
        self._base.elevators.withdraw()
        return True

    def get_out(self, *, rides: bool) -> Routine[None]:
        """Leave the cabin in which it is, if any: nobody else could ride.

        Who `rides` waits until that is open. Who is not out in `_GETS_OUT_S` stays.
        """
        base = self._base
        until_s = base.body.time_s() + _GETS_OUT_S
        while rides and not base.sees_out() and base.body.time_s() < until_s:
            yield
        out = base.ways.way_out(base.body.pose())
        if out is None or not base.sees_out():
            return
        base.start(out, 1.0)
        while not self._driving.is_at(out) and base.body.time_s() < until_s:
            base.drive_on()
            yield
        base.stop()

    def is_over(self, ride: Ride) -> bool:
        """Whether the cabin is open at the floor where a ride ends."""
        base = self._base
        return base.sees_out() and base.ways.floor(base.body.pose()) == ride.to_floor

    def _is_carried_out(self, ride: Ride) -> bool:
        """Whether it knows that it stands on a floor, well out of the cabin that it was in."""
        base = self._base
        if base.whereabouts.is_lost:
            return False
        here = base.body.pose()
        far = here.distance_m(ride.inside) > 2 * CABIN_M
        return far and base.sees_out() and base.ways.elevator_at(here) is None

    def is_led_in(self, ride: Ride) -> bool:
        """Whether whom it leads is in the cabin with it."""
        base = self._base
        return base.company.is_at(ride.inside, IN_CABIN_M, base.body.pose())

    def _let_in(self, ride: Ride) -> Routine[None]:
        """Keep the cabin open until whom it leads is in it; it may be shut, with them, already."""
        base, progress = self._base, self._progress
        progress.alone_since_s = base.body.time_s()
        while base.sees_out() and not self.is_led_in(ride):
            base.elevators.ask(ride, stay_open=True)
            self._watch.check_if_due()
            yield
        progress.alone_since_s = None

    def _is_in(self, ride: Ride) -> bool:
        """Whether the whole robot is in the cabin."""
        here = self._base.body.pose()
        return here.distance_m(ride.inside) < CABIN_M - self._base.body.radius_m

    def _await(
        self, ride: Ride, *, aboard: bool, until: Callable[[], bool], stay_open: bool = False
    ) -> Routine[None]:
        wait = self._progress.wait = Wait(ride, aboard, self._base.body.time_s())
        self._base.may_stand_aside = not aboard
        try:
            while not until():
                if not aboard:
                    yield from self._driving.stand_aside(until)
                wait.was_shut |= aboard and not self._base.sees_out()
                self._base.elevators.ask(ride, stay_open=stay_open)
                self._watch.check_if_due()
                yield
        finally:
            self._base.may_stand_aside = False
        self._progress.wait = None
