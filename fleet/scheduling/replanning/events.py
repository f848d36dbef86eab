"""What can happen to a fleet at work; robots, items and places by name, times in seconds."""

from dataclasses import dataclass

from mend.fleet.scheduling.problem import Item


class EventError(Exception):
    """An event that makes no sense; says why. The fleet is then as it was."""


@dataclass(frozen=True, slots=True)
class NewItem:
    """Somebody asks for one more delivery."""

    item: Item


@dataclass(frozen=True, slots=True)
class NewItems:
    """Somebody asks for several more deliveries, which are planned at once."""

    items: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class Cancelled:
    """An item is not wanted any more; what has been picked up already goes back."""

    item: str


@dataclass(frozen=True, slots=True)
class RobotDelayed:
    """What a robot does now takes so much longer."""

    robot: str
    by_s: float


@dataclass(frozen=True, slots=True)
class RobotFailed:
    """A robot stands still; others fetch what it has on board, unless that is `lost`.

    `at`: the place where it stands; None where nobody knows it better than the plan.
    """

    robot: str
    lost: frozenset[str] = frozenset()
    at: str | None = None


@dataclass(frozen=True, slots=True)
class RobotBack:
    """A robot that had failed works again, at this place."""

    robot: str
    place: str


@dataclass(frozen=True, slots=True)
class RobotMoved:
    """A robot that had nothing to do, or works no more, is elsewhere than the plan knows of."""

    robot: str
    place: str


@dataclass(frozen=True, slots=True)
class WayBlocked:
    """Nobody can pass between two neighbouring places until they hear otherwise."""

    between: tuple[str, str]


@dataclass(frozen=True, slots=True)
class DoorClosed:
    """A door is closed; whoever needs it tries again after `retry_s`, when it counts as open."""

    between: tuple[str, str]
    retry_s: float


@dataclass(frozen=True, slots=True)
class WayOpen:
    """What was blocked or closed can be passed again."""

    between: tuple[str, str]


@dataclass(frozen=True, slots=True)
class TimePassed:
    """Nothing but time has gone by: items that had no place are tried again."""


@dataclass(frozen=True, slots=True)
class SetOut:
    """A robot leaves for its next stop."""

    robot: str


@dataclass(frozen=True, slots=True)
class StopBegun:
    """A robot is there and begins with what it has to do at its stop."""

    robot: str


@dataclass(frozen=True, slots=True)
class StopMade:
    """A robot has done what it had to do at its stop.

    `closes`: the item is dealt with altogether, as a visit is, and nothing is left to deliver.
    """

    robot: str
    closes: bool = False


@dataclass(frozen=True, slots=True)
class StopFailed:
    """A robot has not done what it had to do at its stop, and is at the place `at` now.

    It may be tried again from `again_s` on. None: what has not been picked up is not wanted any
    more, what has been goes back.
    """

    robot: str
    at: str
    again_s: float | None


@dataclass(frozen=True, slots=True)
class LetGo:
    """What a robot has set out for, and does not have aboard, may be done by another one.

    `at`: the place that it has come to, and where it stands.
    """

    robot: str
    at: str


@dataclass(frozen=True, slots=True)
class ItemLost:
    """An item that was on its way is gone."""

    item: str


@dataclass(frozen=True, slots=True)
class Stranded:
    """No robot brings an item any further: it stays aboard, or where it lies, for a person."""

    item: str


@dataclass(frozen=True, slots=True)
class Fetched:
    """A person took an item from a robot, or from where it lay, and has it now."""

    item: str


Event = (
    NewItem
    | NewItems
    | Cancelled
    | RobotDelayed
    | RobotFailed
    | RobotBack
    | RobotMoved
    | WayBlocked
    | DoorClosed
    | WayOpen
    | TimePassed
    | SetOut
    | StopBegun
    | StopMade
    | StopFailed
    | LetGo
    | ItemLost
    | Stranded
    | Fetched
)
