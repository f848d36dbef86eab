"""Whether a schedule can be carried out, judged from its stops alone.

Shares nothing with the solvers and nothing with how times are computed: what has passed here
keeps every load, window, order and duration, whoever made it.
"""

from collections import defaultdict
from collections.abc import Iterator
from itertools import pairwise
from math import isfinite

from mend.fleet.scheduling.itinerary import (
    BrokenItineraryError,
    ItineraryLeg,
    itineraries,
    itinerary_of,
)
from mend.fleet.scheduling.problem import Item, Problem, Window
from mend.fleet.scheduling.schedule import Action, Schedule, Stop
from mend.fleet.scheduling.tolerance import CHECK_S, LOAD


class ScheduleError(Exception):
    """A schedule that cannot be carried out; raised by `require_valid`."""

    def __init__(self, violations: list[str]) -> None:
        super().__init__("; ".join(violations))
        self.violations = violations


def require_valid(problem: Problem, schedule: Schedule) -> Schedule:
    """The schedule itself. Raises `ScheduleError` when it violates anything."""
    violations = check(problem, schedule)
    if violations:
        raise ScheduleError(violations)
    return schedule


def check(problem: Problem, schedule: Schedule) -> list[str]:
    """Everything that is wrong with a schedule, a sentence each; empty when it is valid."""
    if len(schedule.robots) != len(problem.robots):
        return [f"there are {len(schedule.robots)} routes for {len(problem.robots)} robots"]
    violations = [
        violation
        for robot in range(len(problem.robots))
        for violation in (*_drive(problem, schedule, robot), *_loads(problem, schedule, robot))
    ]
    ways, broken = _ways(problem, schedule)
    violations.extend(broken)
    for number, legs in ways.items():
        violations.extend(_item(problem, schedule, problem.items[number], legs))
    violations.extend(_waiting_in_a_circle(problem, schedule, ways))
    return violations


def _ways(
    problem: Problem, schedule: Schedule
) -> tuple[dict[int, tuple[ItineraryLeg, ...]], list[str]]:
    """The ways of the items that have one, and a sentence for each of the others."""
    routes = schedule.routes
    try:
        return itineraries(problem, routes), []
    except BrokenItineraryError:
        # One by one, which takes longer, to name all that are broken.
        ways: dict[int, tuple[ItineraryLeg, ...]] = {}
        broken = []
        for number in range(len(problem.items)):
            try:
                ways[number] = itinerary_of(problem, routes, number)
            except BrokenItineraryError as error:
                broken.append(str(error))
        return ways, broken


def _drive(problem: Problem, schedule: Schedule, robot: int) -> Iterator[str]:
    """Travel, waiting, service, shift and duration of one robot."""
    described, planned = problem.robots[robot], schedule.robots[robot]
    who = described.name
    place, free_s = described.start, planned.leaves_s
    if planned.leaves_s < described.shift.earliest_s - CHECK_S:
        yield f"{who} leaves at {planned.leaves_s:g} s, before its shift begins"
    for stop in planned.stops:
        if not 0 <= stop.task.item < len(problem.items):
            yield f"{who} has a stop with item {stop.task.item}, which does not exist"
            return
        what = f"{stop.task.action} {problem.items[stop.task.item].name}"
        if not _can_be_there(problem, robot, (place, stop.task.place), free_s, stop.arrival_s):
            yield f"{who} cannot be there to {what} at {stop.arrival_s:g} s"
        if not stop.begin_s >= stop.arrival_s - CHECK_S:
            yield f"{who} begins to {what} before it arrives"
        if not stop.departure_s >= stop.begin_s + _service_s(problem, stop) - CHECK_S:
            yield f"{who} departs before it is done with {what}"
        place, free_s = stop.task.place, stop.departure_s
    end = place if described.end is None else described.end
    if not _can_be_there(problem, robot, (place, end), free_s, planned.ends_s):
        yield f"{who} cannot be at its end at {planned.ends_s:g} s"
    if not planned.ends_s <= described.shift.latest_s + CHECK_S:
        yield f"{who} is at its end at {planned.ends_s:g} s, after its shift"
    if not planned.ends_s - planned.leaves_s <= described.max_duration_s + CHECK_S:
        yield f"{who} is away for longer than {described.max_duration_s:g} s"


def _can_be_there(
    problem: Problem, robot: int, trip: tuple[int, int], leaves_s: float, arrival_s: float
) -> bool:
    """Whether the way is open for long enough at some time between leaving and arriving."""
    if not isfinite(arrival_s):
        return False
    travel = problem.travel
    if trip[0] == trip[1] or not travel.epochs:
        return arrival_s >= leaves_s + problem.travel_time_s(robot, *trip) - CHECK_S
    speed = problem.robots[robot].speed
    return any(
        max(leaves_s, epoch.from_s) + epoch.time_s[trip] / speed
        <= min(arrival_s, epoch.until_s) + CHECK_S
        for epoch in travel.epochs
    )


def _service_s(problem: Problem, stop: Stop) -> float:
    item = problem.items[stop.task.item]
    if stop.task.action is Action.PICK:
        return item.pickup.service_s
    if stop.task.action is Action.DROP:
        return item.delivery.service_s
    return problem.transfers.service_s


def _loads(problem: Problem, schedule: Schedule, robot: int) -> Iterator[str]:
    capacity = problem.robots[robot].capacity
    load = sum(item.load for item in problem.items if item.aboard == robot)
    if load > capacity + LOAD:
        yield f"{problem.robots[robot].name} carries {load:g} at the beginning, more than it can"
    for stop in schedule.robots[robot].stops:
        item = problem.items[stop.task.item]
        load += item.load if stop.task.action.loads else -item.load
        if load > capacity + LOAD:
            name = problem.robots[robot].name
            yield f"{name} carries {load:g} after it has item '{item.name}', more than {capacity:g}"


def _item(
    problem: Problem, schedule: Schedule, item: Item, legs: tuple[ItineraryLeg, ...]
) -> Iterator[str]:
    """Places, windows, transfers and the time on board of one item."""

    def stop(robot: int, index: int) -> Stop:
        return schedule.robots[robot].stops[index]

    first, last = legs[0], legs[-1]
    loaded_s = 0.0
    if first.load is not None:
        pick = stop(first.robot, first.load)
        loaded_s = pick.departure_s
        if pick.task.place != item.pickup.place:
            yield f"item '{item.name}' is picked up at the wrong place"
        yield from _window(f"the pickup of item '{item.name}'", pick, item.pickup.window)
    drop = stop(last.robot, last.unload)
    if drop.task.place != item.delivery.place:
        yield f"item '{item.name}' is delivered to the wrong place"
    yield from _window(f"the delivery of item '{item.name}'", drop, item.delivery.window)
    if not drop.begin_s - loaded_s <= item.max_on_board_s + CHECK_S:
        yield f"item '{item.name}' is on board for {drop.begin_s - loaded_s:g} s, too long"
    if item.direct and len(legs) > 1:
        yield f"item '{item.name}' changes robots, which it may not"
    for giving, taking in pairwise(legs):
        assert taking.load is not None, "only the first leg may begin without a load"
        give, take = stop(giving.robot, giving.unload), stop(taking.robot, taking.load)
        yield from _transfer(problem, item, give, take)


def _window(what: str, stop: Stop, window: Window) -> Iterator[str]:
    if not stop.begin_s >= window.earliest_s - CHECK_S:
        yield f"{what} begins at {stop.begin_s:g} s, before {window.earliest_s:g} s"
    if not stop.begin_s <= window.latest_s + CHECK_S:
        yield f"{what} begins at {stop.begin_s:g} s, after {window.latest_s:g} s"


def _transfer(problem: Problem, item: Item, give: Stop, take: Stop) -> Iterator[str]:
    if give.task.place not in problem.transfers.places:
        place = problem.places[give.task.place]
        yield f"item '{item.name}' changes robots at {place}, which is no transfer place"
    if problem.transfers.together:
        if abs(take.begin_s - give.begin_s) > CHECK_S:
            yield f"item '{item.name}' changes robots, but they are not there together"
    elif not take.begin_s >= give.departure_s - CHECK_S:
        yield f"item '{item.name}' is taken at {take.begin_s:g} s, before it was given"


def _waiting_in_a_circle(
    problem: Problem, schedule: Schedule, ways: dict[int, tuple[ItineraryLeg, ...]]
) -> Iterator[str]:
    """Robots that each wait for another one never go on, however the times look."""
    after: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
    waits: dict[tuple[int, int], int] = defaultdict(int)
    for robot, planned in enumerate(schedule.robots):
        for index in range(1, len(planned.stops)):
            after[robot, index - 1].append((robot, index))
            waits[robot, index] += 1
    for legs in ways.values():
        for giving, taking in pairwise(legs):
            assert taking.load is not None, "only the first leg may begin without a load"
            after[giving.robot, giving.unload].append((taking.robot, taking.load))
            waits[taking.robot, taking.load] += 1
    stops = [(k, n) for k, planned in enumerate(schedule.robots) for n in range(len(planned.stops))]
    ready = [stop for stop in stops if not waits[stop]]
    gone = 0
    while ready:
        gone += 1
        for each in after[ready.pop()]:
            waits[each] -= 1
            if not waits[each]:
                ready.append(each)
    if gone < len(stops):
        stuck = sorted({problem.robots[k].name for k, n in stops if waits[k, n]})
        yield f"{', '.join(stuck)} wait for each other in a circle"
