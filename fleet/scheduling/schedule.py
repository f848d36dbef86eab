"""Who does what, where and when: the stops of every robot."""

from dataclasses import dataclass
from enum import StrEnum


class Action(StrEnum):
    """What a robot does with an item at a stop."""

    PICK = "pick"
    DROP = "drop"
    GIVE = "give"
    TAKE = "take"

    @property
    def loads(self) -> bool:
        """Whether the item is on board afterwards."""
        return self in (Action.PICK, Action.TAKE)


@dataclass(frozen=True, slots=True)
class Task:
    """One action with one item at one place; what a route is made of, without times.

    `partner`: the robot that takes what is given here, or gave what is taken here.
    """

    place: int
    action: Action
    item: int
    partner: int | None = None


Route = tuple[Task, ...]
"""What one robot does, in order."""


@dataclass(frozen=True, slots=True)
class Stop:
    """A task with its times (seconds). The robot waits from `arrival_s` to `begin_s`."""

    task: Task
    arrival_s: float
    begin_s: float
    departure_s: float


@dataclass(frozen=True, slots=True)
class RobotSchedule:
    """One robot's stops in order; when it leaves its start and when it is at its end."""

    stops: tuple[Stop, ...]
    leaves_s: float
    ends_s: float

    @property
    def used(self) -> bool:
        """Whether it has anything to do."""
        return bool(self.stops)


@dataclass(frozen=True, slots=True)
class Schedule:
    """The schedules of all robots, in the problem's order."""

    robots: tuple[RobotSchedule, ...]

    @property
    def routes(self) -> tuple[Route, ...]:
        """The same without times."""
        return tuple(tuple(stop.task for stop in robot.stops) for robot in self.robots)

    @property
    def transfers(self) -> int:
        """How often an item changes robots."""
        return sum(stop.task.action is Action.GIVE for robot in self.robots for stop in robot.stops)
