"""A fleet's state as a strict document, and back; what is without end is null there."""

from math import inf
from typing import Annotated

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.errors import UnreadableError
from mend.fleet.scheduling.problem import Item, Robot, Visit, Window
from mend.fleet.scheduling.replanning.fleet_state import FleetState
from mend.fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.residual_problem import Building
from mend.fleet.scheduling.replanning.robot_state import TrackedRobot, Trip
from mend.fleet.scheduling.schedule import Action, Task

Number = Annotated[int, Field(ge=0)]
Finite = Annotated[float, Field(allow_inf_nan=False)]


class KeptVisit(StrictModel):
    """One end of an item's way."""

    place: str
    earliest_s: Finite
    latest_s: Finite | None
    due_s: Finite | None
    service_s: Finite

    @classmethod
    def of(cls, visit: Visit, names: tuple[str, ...]) -> "KeptVisit":
        """The same as a document."""
        return cls(
            place=names[visit.place],
            earliest_s=visit.window.earliest_s,
            latest_s=_or_none(visit.window.latest_s),
            due_s=_or_none(visit.due_s),
            service_s=visit.service_s,
        )

    def visit(self, numbers: dict[str, int]) -> Visit:
        """The same in a problem."""
        window = Window(self.earliest_s, _or_inf(self.latest_s))
        return Visit(numbers[self.place], window, _or_inf(self.due_s), self.service_s)


class KeptTask(StrictModel):
    """What a robot is to do with an item, or does."""

    place: str
    action: Action
    item: Number
    partner: Number | None

    @classmethod
    def of(cls, task: Task, names: tuple[str, ...]) -> "KeptTask":
        """The same as a document."""
        place = names[task.place]
        return cls(place=place, action=task.action, item=task.item, partner=task.partner)

    def task(self, numbers: dict[str, int]) -> Task:
        """The same in a route."""
        return Task(numbers[self.place], self.action, self.item, self.partner)


class KeptTrip(StrictModel):
    """A robot is on its way."""

    origin: str
    leaves_s: Finite
    keeps: bool


class KeptRobot(StrictModel):
    """Where a robot is, and what it does and is to do."""

    name: str
    place: str
    free_s: Finite
    trip: KeptTrip | None
    works: bool
    left_s: Finite | None
    overtime_until_s: Finite | None
    doing: KeptTask | None
    begun_s: Finite | None
    route: tuple[KeptTask, ...]
    moved: tuple[Number, ...]


class KeptItem(StrictModel):
    """An item, and how far it has come."""

    name: str
    load: Finite
    pickup: KeptVisit
    delivery: KeptVisit
    max_on_board_s: Finite | None
    direct: bool
    state: ItemState
    robot: Number | None
    place: str | None
    ready_s: Finite
    loaded_s: Finite | None
    returns: bool
    overdue: bool
    put_off: str | None
    withdrawn: bool
    held_by: Number | None = None
    taken_from: tuple[Number, ...] = ()


class KeptClosing(StrictModel):
    """A way that counts as closed until a time (null: until it is found open)."""

    between: tuple[str, str]
    until_s: Finite | None


class FleetSnapshot(StrictModel):
    """All that is known of a fleet at work."""

    now_s: Finite
    robots: tuple[KeptRobot, ...]
    items: tuple[KeptItem, ...]
    closed: tuple[KeptClosing, ...]


def fleet_snapshot(state: FleetState) -> FleetSnapshot:
    """A state as a document."""
    closed = {} if state.ways is None else state.ways.closed_until_s
    names = state.building.places
    return FleetSnapshot(
        now_s=state.now_s,
        robots=tuple(_kept_robot(state, number) for number in range(len(state.robots))),
        items=tuple(_kept_item(item, names) for item in state.items),
        closed=tuple(
            KeptClosing(between=_pair(way), until_s=_or_none(until_s))
            for way, until_s in closed.items()
        ),
    )


def state_of(
    snapshot: FleetSnapshot, building: Building, robots: tuple[Robot, ...], ways: OpenWays
) -> FleetState:
    """The state that a document describes, of these robots.

    Raises `UnreadableError` where it names what is not there any more.
    """
    numbers = {name: number for number, name in enumerate(building.places)}
    if tuple(each.name for each in snapshot.robots) != tuple(each.name for each in robots):
        raise UnreadableError("what was kept is of other robots than those of the fleet")
    for closing in snapshot.closed:
        until_s = _or_inf(closing.until_s)
        if ways.closed_until_s.get(frozenset(closing.between)) != until_s:
            ways.close(closing.between, until_s)
    try:
        return FleetState(
            building,
            ways.travel(),
            ways,
            [
                _robot(kept, robot, numbers)
                for kept, robot in zip(snapshot.robots, robots, strict=True)
            ],
            [_item(kept, numbers) for kept in snapshot.items],
            [tuple(task.task(numbers) for task in kept.route) for kept in snapshot.robots],
            snapshot.now_s,
            moved_by={
                number: set(kept.moved) for number, kept in enumerate(snapshot.robots) if kept.moved
            },
        )
    except KeyError as error:
        raise UnreadableError(f"what was kept names the place {error}, which is gone") from error


def _kept_robot(state: FleetState, number: int) -> KeptRobot:
    robot, names = state.robots[number], state.building.places
    trip = robot.trip
    return KeptRobot(
        name=robot.robot.name,
        place=names[robot.place],
        free_s=robot.free_s,
        trip=None
        if trip is None
        else KeptTrip(origin=names[trip.origin], leaves_s=trip.leaves_s, keeps=trip.keeps),
        works=robot.works,
        left_s=robot.left_s,
        overtime_until_s=_or_none(robot.overtime_until_s),
        doing=None if robot.doing is None else KeptTask.of(robot.doing, names),
        begun_s=robot.begun_s,
        route=tuple(KeptTask.of(task, names) for task in state.routes[number]),
        moved=tuple(sorted(state.moved_by.get(number, ()))),
    )


def _robot(kept: KeptRobot, robot: Robot, numbers: dict[str, int]) -> TrackedRobot:
    trip = kept.trip
    return TrackedRobot(
        robot,
        numbers[kept.place],
        kept.free_s,
        None if trip is None else Trip(numbers[trip.origin], trip.leaves_s, trip.keeps),
        kept.works,
        kept.left_s,
        -inf if kept.overtime_until_s is None else kept.overtime_until_s,
        None if kept.doing is None else kept.doing.task(numbers),
        kept.begun_s,
    )


def _kept_item(item: TrackedItem, names: tuple[str, ...]) -> KeptItem:
    return KeptItem(
        name=item.item.name,
        load=item.item.load,
        pickup=KeptVisit.of(item.item.pickup, names),
        delivery=KeptVisit.of(item.item.delivery, names),
        max_on_board_s=_or_none(item.item.max_on_board_s),
        direct=item.item.direct,
        state=item.state,
        robot=item.robot,
        place=None if item.place is None else names[item.place],
        ready_s=item.ready_s,
        loaded_s=item.loaded_s,
        returns=item.returns,
        overdue=item.overdue,
        put_off=item.put_off,
        withdrawn=item.withdrawn,
        held_by=item.held_by,
        taken_from=tuple(sorted(item.taken_from)),
    )


def _item(kept: KeptItem, numbers: dict[str, int]) -> TrackedItem:
    item = Item(
        kept.name,
        kept.load,
        kept.pickup.visit(numbers),
        kept.delivery.visit(numbers),
        _or_inf(kept.max_on_board_s),
        direct=kept.direct,
    )
    return TrackedItem(
        item,
        kept.state,
        kept.robot,
        None if kept.place is None else numbers[kept.place],
        kept.ready_s,
        kept.loaded_s,
        kept.returns,
        kept.overdue,
        kept.put_off,
        kept.withdrawn,
        kept.held_by,
        set(kept.taken_from),
    )


def _pair(way: frozenset[str]) -> tuple[str, str]:
    a, b = sorted(way)
    return a, b


def _or_none(value: float) -> float | None:
    return None if value in (inf, -inf) else value


def _or_inf(value: float | None) -> float:
    return inf if value is None else value
