"""OR-Tools' routing library: guided local search from a parallel cheapest insertion."""

from collections.abc import Callable
from math import ceil, isfinite
from typing import Any

import numpy as np
from ortools.constraint_solver import pywrapcp, routing_enums_pb2
from peers.scheduling_answer import answer
from peers.whole_numbers import SCALE, WholeNumbers

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Schedule
from mend.fleet.scheduling.solution import Progress, Solution


def solve_by_ortools_routing(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,  # noqa: ARG001 - every solver takes one; this one draws nothing
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """A schedule without transfers; not worse than `start`. Raises `UnsupportedError`."""
    began_s = clock()
    model = _RoutingModel(problem)
    parameters = pywrapcp.DefaultRoutingSearchParameters()
    parameters.first_solution_strategy = (
        routing_enums_pb2.FirstSolutionStrategy.PARALLEL_CHEAPEST_INSERTION
    )
    parameters.local_search_metaheuristic = (
        routing_enums_pb2.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    )
    parameters.time_limit.FromMilliseconds(max(1, round(seconds * 1000)))
    assignment = model.routing.SolveWithParameters(parameters)
    visits = None if assignment is None else model.visits(assignment)
    return answer(problem, visits, clock() - began_s, start, on_progress)


class _RoutingModel:
    """Nodes: item i's pickup is 2i, its delivery 2i + 1; then each robot's start and end."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._numbers = WholeNumbers(problem, "OR-Tools' routing library")
        self._places = [
            place for item in problem.items for place in (item.pickup.place, item.delivery.place)
        ]
        self._first = len(self._places)
        starts, ends = [], []
        for robot in problem.robots:
            starts.append(len(self._places))
            ends.append(len(self._places) + 1)
            self._places += [robot.start, self._numbers.end(robot.end)]
        robots = len(problem.robots)
        self._manager = pywrapcp.RoutingIndexManager(len(self._places), robots, starts, ends)
        self.routing = pywrapcp.RoutingModel(self._manager)
        self._add_costs()
        self._add_loads()
        self._add_times()
        self._add_items()

    def visits(self, assignment: Any) -> list[list[tuple[int, Action]]]:
        """What every robot does in a solution."""
        found = []
        for robot in range(len(self._problem.robots)):
            index, route = self.routing.Start(robot), []
            while not self.routing.IsEnd(index):
                node = self._manager.IndexToNode(index)
                if node < self._first:
                    route.append((node // 2, Action.DROP if node % 2 else Action.PICK))
                index = assignment.Value(self.routing.NextVar(index))
            found.append(route)
        return found

    def _add_costs(self) -> None:
        costs = self._numbers.cost[np.ix_(self._places, self._places)]
        registered = self.routing.RegisterTransitMatrix(costs.tolist())
        self.routing.SetArcCostEvaluatorOfAllVehicles(registered)
        self.routing.SetFixedCostOfAllVehicles(round(self._problem.weights.robots * SCALE))

    def _add_loads(self) -> None:
        loads = [
            sign * ceil(item.load * SCALE - 1e-6)
            for item in self._problem.items
            for sign in (1, -1)
        ]
        loads += [0] * (len(self._places) - len(loads))
        total = sum(load for load in loads if load > 0)
        capacities = [
            int(min(robot.capacity * SCALE + 1e-6, total)) for robot in self._problem.robots
        ]
        self.routing.AddDimensionWithVehicleCapacity(
            self.routing.RegisterUnaryTransitVector(loads), 0, capacities, True, "load"
        )

    def _add_times(self) -> None:
        services = [
            ceil(visit.service_s * SCALE - 1e-6)
            for item in self._problem.items
            for visit in (item.pickup, item.delivery)
        ]
        services += [0] * (len(self._places) - len(services))
        registered: dict[float, int] = {}
        for speed in {robot.speed for robot in self._problem.robots}:
            times = self._numbers.time(speed)[np.ix_(self._places, self._places)]
            times = times + np.array(services)[:, None]
            registered[speed] = self.routing.RegisterTransitMatrix(times.tolist())
        horizon = self._numbers.horizon
        self.routing.AddDimensionWithVehicleTransits(
            [registered[robot.speed] for robot in self._problem.robots],
            horizon,
            horizon,
            False,
            "time",
        )
        time = self.routing.GetDimensionOrDie("time")
        for number, robot in enumerate(self._problem.robots):
            window = self._numbers.window(robot.shift)
            time.CumulVar(self.routing.Start(number)).SetRange(*window)
            time.CumulVar(self.routing.End(number)).SetRange(*window)
            if isfinite(robot.max_duration_s):
                time.SetSpanUpperBoundForVehicle(int(robot.max_duration_s * SCALE + 1e-6), number)

    def _add_items(self) -> None:
        time, solver = self.routing.GetDimensionOrDie("time"), self.routing.solver()
        for number, item in enumerate(self._problem.items):
            pick = self._manager.NodeToIndex(2 * number)
            drop = self._manager.NodeToIndex(2 * number + 1)
            self.routing.AddPickupAndDelivery(pick, drop)
            solver.Add(self.routing.VehicleVar(pick) == self.routing.VehicleVar(drop))
            solver.Add(time.CumulVar(pick) <= time.CumulVar(drop))
            time.CumulVar(pick).SetRange(*self._numbers.window(item.pickup.window))
            time.CumulVar(drop).SetRange(*self._numbers.window(item.delivery.window))
            if isfinite(item.max_on_board_s):
                longest = int((item.max_on_board_s + item.pickup.service_s) * SCALE + 1e-6)
                solver.Add(time.CumulVar(drop) - time.CumulVar(pick) <= longest)
