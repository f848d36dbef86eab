"""A behavior of a base: the list of its drives, and what it may know when it lays them out."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from mend.documents.strict_model import StrictModel
from mend.robots.base.body import BasePose
from mend.robots.base.ways import Ride, Ways
from mend.robots.execution.behavior import Behavior
from mend.robots.execution.phase import Phase


@dataclass(frozen=True, slots=True)
class Drive:
    """One step: drive to a pose, at `speed` in (0, 1] of the base's best.

    `wait_s` passes there before the next step. `phase` says what the step is for: monitors watch
    phases.
    """

    name: str
    to: BasePose
    speed: float = 1.0
    wait_s: float = 0.0
    phase: Phase = Phase.TRAVEL


@dataclass(frozen=True, slots=True)
class GetIn:
    """One step: wait before an elevator until it is open for this robot, and get in."""

    name: str
    ride: Ride


@dataclass(frozen=True, slots=True)
class RideUntilThere:
    """One step: stay in an elevator until it is open at the floor where the ride ends."""

    name: str
    ride: Ride


BaseStep: TypeAlias = Drive | GetIn | RideUntilThere


@dataclass(frozen=True, slots=True)
class BaseSituation:
    """What a behavior may know when it lays out its steps.

    `here` is where the base is; `places` are the poses of all that the task's scene names so, and
    `target` is that of the behavior's `place`, None where it has none.
    """

    here: BasePose
    places: Mapping[str, BasePose]
    target: BasePose | None
    ways: Ways


class BaseBehavior(Behavior):
    """What a base does, as a list of steps; a `place` among its parameters is its target."""

    @abstractmethod
    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        """Lay out all steps. Raises `CommandError` where the parameters name what is not there."""


def steps_of_ride(ride: Ride) -> list[BaseStep]:
    """Go to the elevator, get in, and stay in it until it is there."""
    name = ride.elevator
    steps: list[BaseStep] = []
    if ride.wait_at is not None:
        steps += [Drive(f"go to {name}", ride.wait_at), GetIn(f"get into {name}", ride)]
    return [*steps, RideUntilThere(f"ride to {ride.to_floor}", ride)]
