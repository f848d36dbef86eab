"""Routes that grow item by item in their temporal network: what an item costs, tried and undone."""

from collections.abc import Iterable, Mapping, Sequence
from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.constraint import Constraint, ConstraintKind
from mend.fleet.scheduling.itinerary import ItineraryLeg as CarriedLeg
from mend.fleet.scheduling.leg_search import ANYWHERE, RouteTimes
from mend.fleet.scheduling.leg_tables import LegTables
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import items_in, part_schedule, without_items
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Route, Task
from mend.fleet.scheduling.temporal_network import Conflict
from mend.fleet.scheduling.timing import TimedRoutes, service_s
from mend.fleet.scheduling.trajectories import Leg, Trajectory

COMPARED = 6
"""How many possible trajectories are compared where more than distance and robots counts."""
SAME = 1e-9
"""Costs that differ by less are the same."""


class Bid(NamedTuple):
    """What the fleet pays for an item on this trajectory: its marginal cost."""

    cost: float
    trajectory: Trajectory


class GrowingRoutes(TimedRoutes):
    """Timed routes of some of the items, to which others are added.

    `held`: by robot, how many of its first tasks nothing may be put before. `begun`: items whose
    pickup is the first task of this robot already, and nothing more of their way. `nearest`: after
    a bid that found no place, the conflict that asks for the least more time than there is. Raises
    `BrokenItineraryError` where an item of the routes is not delivered.
    """

    def __init__(
        self,
        problem: Problem,
        routes: Sequence[Route],
        held: Sequence[int] | None = None,
        begun: Mapping[int, int] | None = None,
    ) -> None:
        self.begun = dict(begun or {})
        super().__init__(problem, routes, _whole_items(routes, self.begun))
        self.nearest: Conflict[Constraint] | None = None
        self._held = [0] * len(problem.robots) if held is None else list(held)
        self._task_of = self._tasks_by_event()
        self._tables = LegTables(problem)
        weights = problem.weights
        self._timeless = _only_distance_and_robots_count(problem)
        self._bounded = not weights.makespan
        # A circle of robots that wait for each other shows in the network unless it takes no time.
        self._circles = problem.transfers.service_s == 0
        self._doors = bool(problem.travel.epochs)
        self._refresh_times()

    # --- what an item costs ---------------------------------------------------------------------

    def bid(self, item: int, *, transfers: bool = True) -> Bid | None:
        """The lowest marginal cost of an item that was found; None where it has no place."""
        self.nearest = None
        graph = self._tables.graph(item, self._carrier(item), transfers=transfers)
        direct = self._lowest(item, graph.direct(), inf)
        if not transfers:
            return direct
        limit = inf if direct is None else direct.cost - SAME
        bound = limit if self._bounded else inf
        return self._lowest(item, graph.handed_over(bound), limit) or direct

    def award(self, item: int, bid: Bid) -> set[int]:
        """Put the item in for good; the robots whose routes or times are others now.

        Raises `ValueError` where its trajectory does not fit.
        """
        self._put(item, bid.trajectory)
        if self.conflict is not None:
            raise ValueError(f"item {item} does not fit into the routes like that")
        self.begun.pop(item, None)
        if self._doors:
            super().__init__(self.problem, self.routes, _whole_items(self.routes, self.begun))
            self._task_of = self._tasks_by_event()
        return self._refresh_times()

    def still_lowest(self, item: int, bid: Bid, changed: set[int]) -> bool:
        """Whether a bid from before an award still holds: none of its robots has changed, and none
        of those that have would do it cheaper alone."""
        if any(leg.robot in changed for leg in bid.trajectory.legs):
            return False
        carrier = self._carrier(item)
        return all(self._tables.alone(item, carrier, k) >= bid.cost for k in changed)

    def _lowest(self, item: int, trajectories: Iterable[Trajectory], limit: float) -> Bid | None:
        lowest: Bid | None = None
        compared = 0
        for trajectory in trajectories:
            if compared == COMPARED or (self._bounded and trajectory.added >= limit):
                break
            price = self._price(item, trajectory, limit)
            if price is None:
                continue
            compared += 1
            if price < limit:
                lowest, limit = Bid(price, trajectory), price
                if self._timeless:
                    break
        return lowest

    def _price(self, item: int, trajectory: Trajectory, limit: float) -> float | None:
        """The marginal cost of a trajectory, None where it cannot be; the routes stay as they are.

        A cost above `limit` may be too low.
        """
        mark, routes, begins = self.network.mark(), self.routes, list(self.begins)
        makespan_s = self._makespan_s()
        self._put(item, trajectory)
        price: float | None = None
        if self.conflict is None:
            price = self._marginal(item, trajectory, mark, makespan_s, routes)
            if price < limit and ((self._circles and trajectory.places) or self._doors):
                price = self._whole_price(routes, item, price)
        elif self.nearest is None or self.conflict.excess_s < self.nearest.excess_s:
            self.nearest = self.conflict
        self.network.undo(mark)
        self.conflict, self.routes, self.begins = None, routes, begins
        for event in [event for event in self._task_of if event >= len(self.network)]:
            del self._task_of[event]
        return price

    def _marginal(
        self,
        item: int,
        trajectory: Trajectory,
        mark: int,
        makespan_s: float,
        before: Sequence[Route],
    ) -> float:
        weights = self.problem.weights
        price = weights.distance * trajectory.added_m
        price += weights.robots * sum(not before[leg.robot] for leg in trajectory.legs)
        if self._timeless:
            return price
        price += weights.makespan * (self._makespan_s() - makespan_s)
        moved = self.network.moved_since(mark)
        for event, task in self._task_of.items():
            added = task.item == item
            if added or event in moved:
                now = self._timely_cost(task, self.network.earliest_s(event))
                price += now - (0.0 if added else self._timely_cost(task, moved[event]))
        return price

    def _timely_cost(self, task: Task, begin_s: float) -> float:
        """What it costs that a task begins then."""
        weights, item = self.problem.weights, self.problem.items[task.item]
        match task.action:
            case Action.PICK:
                return weights.lateness * max(0.0, begin_s - item.pickup.due_s)
            case Action.DROP:
                late_s = max(0.0, begin_s - item.delivery.due_s)
                done_s = begin_s + item.delivery.service_s
                return weights.completion * done_s + weights.lateness * late_s
            case Action.GIVE | Action.TAKE:
                return 0.0

    def _makespan_s(self) -> float:
        if not self.problem.weights.makespan:
            return 0.0
        ends = (
            self.network.earliest_s(e) for e, r in zip(self.ends, self.routes, strict=True) if r
        )
        return max(ends, default=0.0)

    def _whole_price(self, before: Sequence[Route], item: int, price: float) -> float | None:
        """The price as the checker sees it: no circles, and doors on the way."""
        begun = {each: robot for each, robot in self.begun.items() if each != item}
        now = part_schedule(self.problem, without_items(self.routes, begun))
        if now is None or not self._doors:
            return None if now is None else price
        was = part_schedule(self.problem, without_items(before, self.begun))
        return cost(*now).total - (0.0 if was is None else cost(*was).total)

    def explain(self, item: int) -> Conflict[Constraint] | None:
        """Why no robot can do an item after all else; None where load and ways alone forbid it."""
        self.nearest = None
        carrier = self._carrier(item)
        able = range(len(self.routes)) if carrier is None else (carrier,)
        for robot in able:
            if self.problem.robots[robot].capacity < self.problem.items[item].load:
                continue
            last = len(self.routes[robot])
            leg = Leg(robot, last if carrier is None else None, last)
            self._price(item, Trajectory(0.0, 0.0, (leg,), ()), -inf)
        return self.nearest

    # --- putting an item in -----------------------------------------------------------------------

    def _put(self, item: int, trajectory: Trajectory) -> None:
        """Add the item's tasks and constraints; `conflict` says where they do not fit."""
        carried = []
        for number, leg in enumerate(trajectory.legs):
            load, unload = self._ends_of(item, trajectory, number)
            self._insert(leg.robot, leg.unload_at, unload)
            if leg.load_at is None:
                load_at = None if self.begun.get(item) is None else 0
                carried.append(CarriedLeg(leg.robot, load_at, leg.unload_at))
            else:
                self._insert(leg.robot, leg.load_at, load)
                carried.append(CarriedLeg(leg.robot, leg.load_at, leg.unload_at + 1))
        self._join(item, carried)

    def _ends_of(self, item: int, trajectory: Trajectory, number: int) -> tuple[Task, Task]:
        """How an item is loaded and unloaded on one leg."""
        visits, legs, places = self.problem.items[item], trajectory.legs, trajectory.places
        load = Task(visits.pickup.place, Action.PICK, item)
        unload = Task(visits.delivery.place, Action.DROP, item)
        if number:
            load = Task(places[number - 1], Action.TAKE, item, legs[number - 1].robot)
        if number + 1 < len(legs):
            unload = Task(places[number], Action.GIVE, item, legs[number + 1].robot)
        return load, unload

    def _insert(self, robot: int, at: int, task: Task) -> None:
        """Put one task before task number `at` of a route."""
        route, events = self.routes[robot], self.begins[robot]
        described = self.problem.robots[robot]
        begin = self.network.add_event()
        before, place, busy_s = self.leaves[robot], described.start, 0.0
        if at > 0:
            last = route[at - 1]
            before, place, busy_s = events[at - 1], last.place, service_s(self.problem, last)
        gap_s = busy_s + self.problem.travel_time_s(robot, place, task.place)
        self._demand(begin, before, gap_s, Constraint(ConstraintKind.TRAVEL, robot, task))
        self._demand_window(begin, task)
        busy_s = service_s(self.problem, task)
        if at < len(route):
            gap_s = busy_s + self.problem.travel_time_s(robot, task.place, route[at].place)
            reason = Constraint(ConstraintKind.TRAVEL, robot, route[at])
            self._demand(events[at], begin, gap_s, reason)
        else:
            home_s = 0.0
            if described.end is not None:
                home_s = self.problem.travel_time_s(robot, task.place, described.end)
            reason = Constraint(ConstraintKind.HOMEWARD, robot)
            self._demand(self.ends[robot], begin, busy_s + home_s, reason)
        self._task_of[begin] = task
        self.begins[robot] = [*events[:at], begin, *events[at:]]
        grown = (*route[:at], task, *route[at:])
        self.routes = (*self.routes[:robot], grown, *self.routes[robot + 1 :])

    def _tasks_by_event(self) -> dict[int, Task]:
        return {
            event: task
            for events, route in zip(self.begins, self.routes, strict=True)
            for event, task in zip(events, route, strict=True)
        }

    def _refresh_times(self) -> set[int]:
        """Look at the times of all robots again; the robots that have others now."""
        robots = range(len(self.routes))
        return {robot for robot in robots if self._tables.see(robot, self._route_times(robot))}

    def _carrier(self, item: int) -> int | None:
        """The robot that must begin the item's way."""
        return self.begun.get(item, self.problem.items[item].aboard)

    def _route_times(self, robot: int) -> RouteTimes:
        problem, route, network = self.problem, self.routes[robot], self.network
        described = problem.robots[robot]
        events = [self.leaves[robot], *self.begins[robot]]
        loads = [sum(item.load for item in problem.items if item.aboard == robot)]
        for task in route:
            load = problem.items[task.item].load
            loads.append(loads[-1] + (load if task.action.loads else -load))
        return RouteTimes(
            place=np.array([described.start, *(task.place for task in route)], dtype=np.int64),
            begin_s=np.array([network.earliest_s(event) for event in events]),
            service_s=np.array([0.0, *(service_s(problem, task) for task in route)]),
            latest_s=np.array([network.latest_s(event) for event in events]),
            load=np.array(loads, dtype=np.float64),
            held=self._held[robot],
            end=ANYWHERE if described.end is None else described.end,
            end_latest_s=float(network.latest_s(self.ends[robot])),
            capacity=float(described.capacity),
            speed=float(described.speed),
        )


def _whole_items(routes: Sequence[Route], begun: Mapping[int, int]) -> list[int]:
    return [item for item in items_in(routes) if item not in begun]


def _only_distance_and_robots_count(problem: Problem) -> bool:
    weights = problem.weights
    if weights.makespan or weights.completion or problem.travel.epochs:
        return False
    due = any(min(item.pickup.due_s, item.delivery.due_s) < inf for item in problem.items)
    return not (weights.lateness and due)
