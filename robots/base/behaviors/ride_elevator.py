"""`ride_elevator`: ride to the floor of a place, and get out there."""

from collections.abc import Sequence
from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    BaseBehavior,
    BaseSituation,
    BaseStep,
    Drive,
    steps_of_ride,
)
from mend.robots.execution.command_error import CommandError
from mend.tasks.scene import Name


class RideElevatorParameters(StrictModel):
    """`place`: any place on the floor to ride to."""

    place: Name


class RideElevator(BaseBehavior):
    """Goes to the elevator on the way to a place, rides to the place's floor and gets out."""

    name: ClassVar[str] = "ride_elevator"
    parameters: ClassVar[type[StrictModel]] = RideElevatorParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, RideElevatorParameters), "commands are checked before"
        if situation.target is None:
            raise CommandError("ride_elevator needs a place on the floor to ride to")
        rides = situation.ways.rides(
            situation.here, situation.target, situation.closed, situation.waits_s
        )
        steps: list[BaseStep] = []
        for ride in rides:
            out = Drive(f"get out of {ride.elevator}", ride.out_at)
            steps += [*steps_of_ride(ride), out]
        return steps
