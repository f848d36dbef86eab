"""A behavior of a base: the list of its drives, and what it may know when it lays them out."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from mend.documents.strict_model import StrictModel
from mend.robots.base.basket import Basket, NoBasket
from mend.robots.base.body import BasePose
from mend.robots.base.closed_ways import Closed
from mend.robots.base.companion import Companion, NoCompanion
from mend.robots.base.ways import Ride, Ways
from mend.robots.execution.behavior import Behavior
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.phase import Phase


@dataclass(frozen=True, slots=True)
class Drive:
    """One step: drive to a pose, at `speed` in (0, 1] of the base's best.

    `wait_s` passes there before the next step. `phase` says what the step is for: monitors watch
    phases. `near_m`: it is there, too, where it is so near and something keeps it from going on.
    `leads`: the person who follows; it stands while they do not keep up. `meets`: it is there, too,
    where it sees whom it is to meet there, who keeps it from going on.
    """

    name: str
    to: BasePose
    speed: float = 1.0
    wait_s: float = 0.0
    phase: Phase = Phase.TRAVEL
    near_m: float = 0.0
    leads: str | None = None
    meets: bool = False


@dataclass(frozen=True, slots=True)
class GetIn:
    """One step: wait before an elevator until it is open for this robot, and get in.

    `leads`: who is to have room beside it, if there is any.
    """

    name: str
    ride: Ride
    leads: str | None = None


@dataclass(frozen=True, slots=True)
class RideUntilThere:
    """One step: stay in an elevator until it is open at the floor where the ride ends.

    `leads`: who has to be in it, too, before it leaves, if there is room for both.
    """

    name: str
    ride: Ride
    leads: str | None = None


@dataclass(frozen=True, slots=True)
class AwaitItem:
    """One step: ask for an item at a place, until the basket is heavier."""

    name: str
    item: str
    place: str


@dataclass(frozen=True, slots=True)
class AwaitTaken:
    """One step: offer an item at a place, until the basket is lighter by what that weighs."""

    name: str
    item: str
    place: str


@dataclass(frozen=True, slots=True)
class Tell:
    """One step: tell people a message, until somebody says that it was heard."""

    name: str


@dataclass(frozen=True, slots=True)
class Charging:
    """One step: stand at a charger until the battery is full."""

    name: str


@dataclass(frozen=True, slots=True)
class Meet:
    """One step: wait for a person at a place, until they are seen there."""

    name: str
    person: str
    place: str


@dataclass(frozen=True, slots=True)
class Arrive:
    """One step: wait at a place until the person who was led there is seen there, too."""

    name: str
    person: str
    place: str


StandingStep: TypeAlias = AwaitItem | AwaitTaken | Tell | Charging | Meet | Arrive
"""What is done where the drive before has led."""
BaseStep: TypeAlias = Drive | GetIn | RideUntilThere | StandingStep
UNHEARD = "nobody_answers"
"""The issue that is settled by nothing but somebody's word that a message was heard."""


def phase_of(step: BaseStep) -> Phase:
    """What a step is for."""
    match step:
        case Drive(phase=phase):
            return phase
        case GetIn() | RideUntilThere():
            return Phase.RIDE
        case AwaitItem():
            return Phase.LOAD
        case AwaitTaken():
            return Phase.UNLOAD
        case Tell():
            return Phase.TELL
        case Charging():
            return Phase.CHARGE
        case Meet():
            return Phase.MEET
        case Arrive():
            return Phase.ARRIVE


@dataclass(frozen=True, slots=True)
class BaseSituation:
    """What a behavior may know when it lays out its steps.

    `here` is where the base is; `places` are the poses of all that the task's scene names so, and
    `target` is that of the behavior's `place`, None where it has none. `basket`, `companion`: its
    own. `closed`: the ways that it keeps off.
    """

    here: BasePose
    places: Mapping[str, BasePose]
    target: BasePose | None
    ways: Ways
    basket: Basket = field(default_factory=NoBasket)
    closed: Closed = field(default_factory=dict)
    waits_s: Mapping[str, float] = field(default_factory=dict)
    companion: Companion = field(default_factory=NoCompanion)


class BaseBehavior(Behavior):
    """What a base does, as a list of steps; a `place` among its parameters is its target."""

    @abstractmethod
    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        """Lay out all steps. Raises `CommandError` where the parameters name what is not there."""


LEADS = 0.6
"""So much of its best speed a base drives that somebody on foot follows."""
QUEUES_M = 1.5
"""So near to where it would wait for an elevator it does if others wait there already."""


def steps_of_ride(ride: Ride, leads: str | None = None) -> list[BaseStep]:
    """Go to the elevator, get in, and stay in it until it is there; with whom it `leads`."""
    name = ride.elevator
    steps: list[BaseStep] = []
    if ride.wait_at is not None:
        steps += [
            _drive(f"go to {name}", ride.wait_at, leads, QUEUES_M),
            GetIn(f"get into {name}", ride, leads),
        ]
    return [*steps, RideUntilThere(f"ride to {ride.to_floor}", ride, leads)]


MEETS_M = 1.2
"""People meet a robot at a place that cannot get nearer because somebody stands there."""


def steps_to(
    place: str, situation: BaseSituation, near_m: float = 0.0, leads: str | None = None
) -> list[BaseStep]:
    """Ride to the floor of a place and drive to it, or so near if something is in the way there.

    `leads`: with whom.

    Raises `CommandError` where there is no such place.
    """
    if situation.target is None:
        raise CommandError(f"it is not known where '{place}' is")
    rides = situation.ways.rides(
        situation.here, situation.target, situation.closed, situation.waits_s
    )
    steps = [step for ride in rides for step in steps_of_ride(ride, leads)]
    return [*steps, _drive(f"go to {place}", situation.target, leads, near_m)]


def _drive(name: str, to: BasePose, leads: str | None, near_m: float = 0.0) -> Drive:
    speed = 1.0 if leads is None else LEADS
    return Drive(name, to, speed=speed, near_m=near_m, leads=leads)
