"""An optimum that a bound alone proves, when no search has, is reported as optimal."""

import time
from typing import Any

import pytest
from delivery_problems import corridor, parcel

from mend.fleet.scheduling.exact import route_search
from mend.fleet.scheduling.exact import solve as exact
from mend.fleet.scheduling.problem import Problem, Robot, Transfers
from mend.fleet.scheduling.schedule import Action, Task
from mend.fleet.scheduling.solution import Solution, Status
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule

LEAST = 80.0


def one_way_and_back() -> Problem:
    """One robot that has to drive 80 m to bring the parcel and come back."""
    robots = (Robot("only", 2, 2, 1.0),)
    return corridor(items=(parcel(),), robots=robots, transfers=Transfers())


def nothing_found(*_: Any, **__: Any) -> Solution:
    return Solution(Status.UNKNOWN, None, None, None, 0.0)


@pytest.mark.parametrize("bound", ["routes", "flows"])
def test_optimum_that_only_a_bound_proves_is_optimal(
    bound: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = one_way_and_back()
    item = problem.items[0]
    route = (Task(item.pickup.place, Action.PICK, 0), Task(item.delivery.place, Action.DROP, 0))
    start = earliest_schedule(problem, (route,))
    assert not isinstance(start, Untimeable)
    monkeypatch.setattr(exact, "search", nothing_found)
    monkeypatch.setattr(exact, "windows_are_wide", lambda _: bound == "flows")
    if bound == "routes":
        monkeypatch.setattr(route_search, "MOST_ROUTES", -1)
    else:
        monkeypatch.setattr(route_search, "route_bound", lambda _: None)
    found = exact.solve_exactly(problem, seconds=20.0, start=start, clock=time.perf_counter)
    assert found.cost is not None
    assert found.cost.total == pytest.approx(LEAST)
    assert found.status is Status.OPTIMAL
    assert found.bound == found.cost.total
