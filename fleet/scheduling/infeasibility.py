"""What cannot hold in a problem, whatever the robots do: found without any search.

Every sentence is certain: an item is judged as if there were no other one and every robot were
there for it alone, with at most the transfers that the problem allows.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from mend.fleet.scheduling.constraint import Constraint, ConstraintKind, sentences
from mend.fleet.scheduling.problem import Problem, Robot, Transfers
from mend.fleet.scheduling.schedule import Action, Task
from mend.fleet.scheduling.temporal_network import ORIGIN, Conflict, TemporalNetwork
from mend.fleet.scheduling.timing import TimedRoutes
from mend.fleet.scheduling.tolerance import DOOR_S
from mend.fleet.scheduling.travel import Matrix, Travel


@dataclass(frozen=True, slots=True)
class Infeasibility:
    """One sentence that says what cannot hold, and the item or robot that it is about."""

    sentence: str
    item: int | None = None
    robot: int | None = None


def infeasibilities(problem: Problem) -> list[Infeasibility]:
    """Everything that certainly cannot hold; empty where only a search could tell."""
    found = [*_robots(problem)]
    nearest = _Nearest(problem.travel.time_s)
    for number in range(len(problem.items)):
        # Stopping elsewhere on the way may be quicker where a matrix keeps no triangle inequality.
        why = _item(problem, number, problem.travel.time_s) and _item(
            problem, number, nearest.time_s
        )
        if why:
            found.append(Infeasibility(why, item=number))
    return found


class _Nearest:
    """Travel times over any stops on the way; worked out when they are first asked for."""

    def __init__(self, time_s: Matrix) -> None:
        self._direct_s = time_s
        self._over_stops_s: Matrix | None = None

    @property
    def time_s(self) -> Matrix:
        if self._over_stops_s is None:
            shortest = self._direct_s.copy()
            for via in range(len(shortest)):
                np.minimum(shortest, shortest[:, via, None] + shortest[None, via], out=shortest)
            self._over_stops_s = shortest
        return self._over_stops_s


def _robots(problem: Problem) -> Iterator[Infeasibility]:
    """Even a robot that has nothing to do goes to its end, with what it has aboard."""
    for number, robot in enumerate(problem.robots):
        alone = replace(problem, robots=(robot,), items=(), transfers=Transfers())
        conflict = TimedRoutes(alone, ((),)).conflict
        if conflict is not None:
            why = _conflict_words(alone, conflict)
            yield Infeasibility(f"robot '{robot.name}' cannot get to its end: {why}", robot=number)
        load = sum(item.load for item in problem.items if item.aboard == number)
        if load > robot.capacity:
            yield Infeasibility(
                f"robot '{robot.name}' has a load of {load:g} aboard, but carries only "
                f"{robot.capacity:g}",
                robot=number,
            )


def _item(problem: Problem, number: int, time_s: Matrix) -> str | None:
    """Why an item cannot be delivered even if there is no other one; None where it can be."""
    item = problem.items[number]
    able = [k for k, robot in enumerate(problem.robots) if robot.capacity >= item.load]
    who = f"item '{item.name}'"
    if not able:
        most = max(robot.capacity for robot in problem.robots)
        return f"{who} has a load of {item.load:g}, but no robot carries more than {most:g}"
    places = problem.places
    origin = item.pickup.place
    if item.aboard is not None:
        origin = problem.robots[item.aboard].start
    elif all(time_s[problem.robots[k].start, origin] == inf for k in able):
        return f"no robot that can carry {who} can get to {places[origin]}, where it is picked up"
    if time_s[origin, item.delivery.place] == inf:
        return (
            f"{who} cannot be delivered: there is no way from {places[origin]} to "
            + (places[item.delivery.place])
        )
    closest: tuple[float, str] | None = None
    for giver, taker in _carriers(problem, number, able):
        conflict = _Delivery(problem, number, time_s, giver, taker).conflict
        if conflict is None:
            return None
        if closest is None or conflict.excess_s < closest[0]:
            closest = conflict.excess_s, _conflict_words(problem, conflict)
    assert closest is not None, "somebody is able"
    done = "done" if item.is_visit else "delivered"
    return f"{who} cannot be {done} even if a robot does nothing else: {closest[1]}"


def _carriers(problem: Problem, number: int, able: list[int]) -> Iterator[tuple[int, int]]:
    """Who could pick the item and who could drop it; of robots that are alike only the first."""
    alike: dict[Robot, int] = {}
    for k in able:
        alike.setdefault(replace(problem.robots[k], name=""), k)
    robots = list(alike.values())
    aboard = problem.items[number].aboard
    givers = robots if aboard is None else [aboard]
    for giver in givers:
        yield giver, giver
    if problem.transfers.places and len(able) > 1:
        yield from ((giver, taker) for giver in givers for taker in robots if giver != taker)


def _conflict_words(problem: Problem, conflict: Conflict[Constraint]) -> str:
    words = sentences(problem, conflict.reasons)
    if conflict.excess_s < inf:
        words += f" (together they ask for {conflict.excess_s:g} s more than there is)"
    return words


class _Delivery:
    """The least that must hold when `giver` picks an item and `taker`, maybe the same, drops it."""

    def __init__(
        self, problem: Problem, number: int, time_s: Matrix, giver: int, taker: int
    ) -> None:
        self.conflict: Conflict[Constraint] | None = None
        self._problem, self._time_s = problem, time_s
        self._network: TemporalNetwork[Constraint] = TemporalNetwork()
        self._item = problem.items[number]
        delivery = self._item.delivery
        self._drop_task = Task(delivery.place, Action.DROP, number)
        self._drop = self._network.add_event()
        self._demand(self._drop, ORIGIN, delivery.window.earliest_s, self._window(False))
        self._demand(ORIGIN, self._drop, -delivery.window.latest_s, self._window(True))
        self._leaves: dict[int, int] = {}
        for robot in dict.fromkeys((giver, taker)):
            self._leave(robot)
        if self._item.aboard is None:
            self._pick_and_carry(number, giver, taker)
        else:
            self._carry(self._leaves[giver], problem.robots[giver].start, 0.0, giver, taker)
            on_board = Constraint(ConstraintKind.ON_BOARD, taker, self._drop_task)
            self._demand(ORIGIN, self._drop, -self._item.max_on_board_s, on_board)
        if taker != giver:
            self._get_to(self._drop, taker, self._drop_task)
        self._return(self._drop, taker, delivery.place, delivery.service_s)

    def _demand(self, later: int, earlier: int, gap_s: float, reason: Constraint) -> None:
        if self.conflict is None:
            self.conflict = self._network.after(later, earlier, gap_s, reason)

    def _window(self, closes: bool, task: Task | None = None) -> Constraint:
        kind = ConstraintKind.WINDOW_END if closes else ConstraintKind.WINDOW_BEGIN
        return Constraint(kind, None, task or self._drop_task)

    def _leave(self, robot: int) -> None:
        leaves = self._leaves[robot] = self._network.add_event()
        earliest_s = self._problem.robots[robot].shift.earliest_s
        self._demand(leaves, ORIGIN, earliest_s, Constraint(ConstraintKind.SHIFT_BEGIN, robot))

    def _pick_and_carry(self, number: int, giver: int, taker: int) -> None:
        pickup = self._item.pickup
        task = Task(pickup.place, Action.PICK, number)
        pick = self._network.add_event()
        self._demand(pick, ORIGIN, pickup.window.earliest_s, self._window(False, task))
        self._demand(ORIGIN, pick, -pickup.window.latest_s, self._window(True, task))
        self._get_to(pick, giver, task)
        self._carry(pick, pickup.place, pickup.service_s, giver, taker)
        on_board = Constraint(ConstraintKind.ON_BOARD, taker, self._drop_task)
        longest_s = self._item.max_on_board_s + pickup.service_s
        self._demand(pick, self._drop, -longest_s, on_board)
        if taker != giver:
            self._return(pick, giver, pickup.place, pickup.service_s)

    def _get_to(self, event: int, robot: int, task: Task) -> None:
        start, speed = self._problem.robots[robot].start, self._problem.robots[robot].speed
        leaves = self._leaves[robot]
        travel = Constraint(ConstraintKind.TRAVEL, robot, task)
        self._demand(event, leaves, float(self._time_s[start, task.place]) / speed, travel)
        self._wait_for_doors(event, leaves, (start, task.place), (0.0, speed), travel)

    def _carry(self, load: int, origin: int, service_s: float, giver: int, taker: int) -> None:
        """The item's own way, over the nearest transfer place where it changes robots."""
        problem, destination = self._problem, self._item.delivery.place
        speed = problem.robots[giver].speed
        lasts_s = float(self._time_s[origin, destination])
        handling_s = 0.0
        if taker != giver:
            speed = max(robot.speed for robot in problem.robots)
            places = list(problem.transfers.places)
            over = self._time_s[origin, places] + self._time_s[places, destination]
            lasts_s = float(over.min())
            handling_s = problem.transfers.service_s * (1 if problem.transfers.together else 2)
        travel = Constraint(ConstraintKind.TRAVEL, taker, self._drop_task)
        self._demand(self._drop, load, service_s + lasts_s / speed + handling_s, travel)
        self._wait_for_doors(self._drop, load, (origin, destination), (service_s, speed), travel)

    def _return(self, event: int, robot: int, place: int, service_s: float) -> None:
        described = self._problem.robots[robot]
        ends = self._network.add_event()
        homeward_s = service_s
        if described.end is not None:
            homeward_s += float(self._time_s[place, described.end]) / described.speed
        self._demand(ends, event, homeward_s, Constraint(ConstraintKind.HOMEWARD, robot))
        shift_end = Constraint(ConstraintKind.SHIFT_END, robot)
        self._demand(ORIGIN, ends, -described.shift.latest_s, shift_end)
        duration = Constraint(ConstraintKind.DURATION, robot)
        self._demand(self._leaves[robot], ends, -described.max_duration_s, duration)

    def _wait_for_doors(
        self,
        arrives: int,
        leaves: int,
        trip: tuple[int, int],
        lasting: tuple[float, float],
        travel: Constraint,
    ) -> None:
        """`lasting` holds the service before the trip (seconds) and the speed."""
        if not self._problem.travel.epochs or self.conflict is not None:
            return
        service_s, speed = lasting
        leaves_s = self._network.earliest_s(leaves) + service_s
        arrival_s = _arrivals_s(self._problem.travel, trip[0], leaves_s, speed)[trip[1]]
        opening = Constraint(ConstraintKind.OPENING, travel.robot, travel.task)
        self._demand(arrives, ORIGIN, float(arrival_s), opening)


def _arrivals_s(travel: Travel, origin: int, leaves_s: float, speed: float) -> Matrix:
    """When somebody could be everywhere at the earliest, waiting wherever it helps."""
    arrivals_s = np.full(travel.count, inf)
    arrivals_s[origin] = leaves_s
    left = np.ones(travel.count, dtype=bool)
    while left.any():
        place = int(np.argmin(np.where(left, arrivals_s, inf)))
        if not left[place] or arrivals_s[place] == inf:
            break
        left[place] = False
        for epoch in travel.epochs:
            there_s = max(arrivals_s[place], epoch.from_s) + epoch.time_s[place] / speed
            there_s[there_s > epoch.until_s + DOOR_S] = inf
            np.minimum(arrivals_s, there_s, out=arrivals_s)
    return arrivals_s
