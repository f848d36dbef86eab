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
    """A robot stands still; others fetch what it has on board, unless that is `lost`."""

    robot: str
    lost: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class RobotBack:
    """A robot that had failed works again, at this place."""

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


Event = (
    NewItem
    | Cancelled
    | RobotDelayed
    | RobotFailed
    | RobotBack
    | WayBlocked
    | DoorClosed
    | WayOpen
    | TimePassed
)
