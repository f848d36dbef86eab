"""What is to be scheduled: robots, items, transfer places and travel; checked and immutable.

Times are seconds, distances metres; places, robots and items are numbered from 0.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import inf, isfinite

from mend.fleet.scheduling.travel import Travel


class ProblemError(Exception):
    """A problem that makes no sense; raised with one sentence per mistake."""

    def __init__(self, mistakes: list[str]) -> None:
        super().__init__("; ".join(mistakes))
        self.mistakes = mistakes


@dataclass(frozen=True, slots=True)
class Window:
    """When something may begin (for a robot: may leave its start and must be at its end)."""

    earliest_s: float = 0.0
    latest_s: float = inf


@dataclass(frozen=True, slots=True)
class Visit:
    """One end of an item's way: where, when (hard), until when it is on time (soft), how long."""

    place: int
    window: Window = Window()
    due_s: float = inf
    service_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Item:
    """One delivery. `aboard`: the robot that already carries it, and `pickup` is then over.

    `max_on_board_s` bounds the time between the end of its pickup and the begin of its delivery,
    transfers included. `direct`: it may not change robots.
    """

    name: str
    load: float
    pickup: Visit
    delivery: Visit
    max_on_board_s: float = inf
    aboard: int | None = None
    direct: bool = False

    @property
    def is_visit(self) -> bool:
        """Whether it is brought from nowhere to nowhere: a robot is wanted at one place."""
        return self.aboard is None and self.pickup.place == self.delivery.place


@dataclass(frozen=True, slots=True)
class Robot:
    """One robot. `end` None: it may end anywhere; otherwise it goes there even when it is unused.

    `speed` divides the travel times; `max_duration_s` bounds the time from leaving the start to
    arriving at the end.
    """

    name: str
    start: int
    end: int | None
    capacity: float
    shift: Window = Window()
    max_duration_s: float = inf
    speed: float = 1.0


@dataclass(frozen=True, slots=True)
class Transfers:
    """Where items may change robots.

    `together`: both robots must be there at once; otherwise one may leave the item for the other.
    `service_s` is the time that giving takes, and taking again.
    """

    places: tuple[int, ...] = ()
    together: bool = False
    service_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Weights:
    """What a schedule costs: the weighted sum of these.

    `distance` per metre; `makespan` per second until the last robot is at its end; `completion`
    per second of each item's delivery time; `lateness` per second after what is due; `robots` per
    robot that has anything to do.
    """

    distance: float = 1.0
    makespan: float = 0.0
    completion: float = 0.0
    lateness: float = 1.0
    robots: float = 0.0


@dataclass(frozen=True, slots=True)
class Problem:
    """Everything that a scheduler is given. Raises `ProblemError` where it contradicts itself."""

    name: str
    places: tuple[str, ...]
    travel: Travel
    robots: tuple[Robot, ...]
    items: tuple[Item, ...]
    transfers: Transfers = Transfers()
    weights: Weights = Weights()
    coordinates: tuple[tuple[float, float], ...] | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        mistakes = list(_mistakes(self))
        if mistakes:
            raise ProblemError(mistakes)

    def travel_time_s(self, robot: int, origin: int, destination: int) -> float:
        """How long a robot takes from one place to another, in seconds."""
        return float(self.travel.time_s[origin, destination]) / self.robots[robot].speed

    def without_transfers(self) -> "Problem":
        """The same problem, but no item may change robots."""
        return Problem(
            self.name, self.places, self.travel, self.robots, self.items, Transfers(),
            self.weights, self.coordinates,
        )  # fmt: skip


def _mistakes(problem: Problem) -> Iterator[str]:
    count = len(problem.places)
    if problem.travel.count != count:
        yield f"there are {count} places, but travel is known between {problem.travel.count}"
        return
    if not problem.robots:
        yield "there is no robot"
    for robot in problem.robots:
        yield from _robot_mistakes(robot, count)
    for item in problem.items:
        yield from _item_mistakes(item, count, len(problem.robots))
    for place in problem.transfers.places:
        if not 0 <= place < count:
            yield f"there is no transfer place {place}"
    if not (isfinite(problem.transfers.service_s) and problem.transfers.service_s >= 0):
        yield "the service time of a transfer must be at least 0 and finite"
    for name in ("distance", "makespan", "completion", "lateness", "robots"):
        weight = getattr(problem.weights, name)
        if not (isfinite(weight) and weight >= 0):
            yield f"the weight of {name} must be at least 0 and finite, but it is {weight}"


def _robot_mistakes(robot: Robot, places: int) -> Iterator[str]:
    who = f"robot '{robot.name}'"
    if not 0 <= robot.start < places:
        yield f"{who} starts at place {robot.start}, which does not exist"
    if robot.end is not None and not 0 <= robot.end < places:
        yield f"{who} ends at place {robot.end}, which does not exist"
    if not robot.capacity >= 0:
        yield f"{who} has a capacity of {robot.capacity}; at least 0 would be right"
    if not (isfinite(robot.speed) and robot.speed > 0):
        yield f"{who} has a speed of {robot.speed}; more than 0 would be right"
    if not robot.max_duration_s >= 0:
        yield f"{who} has a longest duration of {robot.max_duration_s} s; it must not be negative"
    yield from _window_mistakes(f"the shift of {who}", robot.shift)


def _item_mistakes(item: Item, places: int, robots: int) -> Iterator[str]:
    who = f"item '{item.name}'"
    if not (isfinite(item.load) and item.load >= 0):
        yield f"{who} has a load of {item.load}; at least 0 would be right"
    if not item.max_on_board_s >= 0:
        yield f"{who} may be on board for {item.max_on_board_s} s; it must not be negative"
    if item.aboard is not None and not 0 <= item.aboard < robots:
        yield f"{who} is aboard robot {item.aboard}, which does not exist"
    for what, visit in (("pickup", item.pickup), ("delivery", item.delivery)):
        if not 0 <= visit.place < places:
            yield f"the {what} of {who} is at place {visit.place}, which does not exist"
        if not (isfinite(visit.service_s) and visit.service_s >= 0):
            yield f"the {what} of {who} takes {visit.service_s} s; at least 0 would be right"
        yield from _window_mistakes(f"the {what} of {who}", visit.window)


def _window_mistakes(what: str, window: Window) -> Iterator[str]:
    if not isfinite(window.earliest_s) or window.latest_s != window.latest_s:
        yield f"the window of {what} is no number"
    elif window.earliest_s > window.latest_s:
        yield f"the window of {what} ends at {window.latest_s:g} s, before it begins"
