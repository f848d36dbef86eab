"""Public solvers behind the same interface: valid schedules, or a sentence that says what is not.

Those of the extra `peers` are left out where it is not installed.
"""

import importlib
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from benchmark_instances import DATA
from delivery_problems import corridor, parcel
from ticking_clock import TickingClock

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.instances.li_lim import read_li_lim
from mend.fleet.scheduling.problem import Item, Problem, Robot, Visit, Weights, Window
from mend.fleet.scheduling.solution import Solution, Status, UnsupportedError
from mend.fleet.scheduling.travel import Epoch, Travel

Peer = Callable[..., Solution]


@pytest.fixture(params=["ortools_routing", "pyvrp", "vroom"])
def peer(request: pytest.FixtureRequest) -> Any:
    name = request.param
    if name == "ortools_routing":
        module = importlib.import_module("mend.fleet.scheduling.peers.ortools_routing")
    else:
        pytest.importorskip(name, reason="the extra 'peers' is not installed")
        module = importlib.import_module(f"mend.fleet.scheduling.peers.{name}_search")
    return getattr(module, f"solve_by_{name}")


def solve(peer: Peer, problem: Problem, **given: Any) -> Solution:
    return peer(problem, seconds=0.5, seed=1, clock=TickingClock(), **given)


def test_schedule_is_the_shortest_of_a_small_problem(peer: Peer) -> None:
    items = (parcel(), parcel("back", 4, 1))
    found = solve(peer, corridor(items=items, robots=(Robot("left", 0, 0, 2.0),)))
    assert found.status is Status.FEASIBLE
    assert found.cost is not None
    assert found.cost.distance_m == 80.0


def test_windows_loads_speeds_and_open_ends_are_kept(peer: Peer) -> None:
    items = (
        Item("early", 2.0, Visit(3, Window(0.0, 8.0), service_s=2.0), Visit(4)),
        Item("late", 2.0, Visit(3, Window(30.0)), Visit(0, Window(0.0, 200.0), service_s=5.0)),
        Item("other", 1.0, Visit(1), Visit(2)),
    )
    robots = (Robot("left", 0, None, 2.0, Window(5.0)), Robot("right", 4, 4, 2.0, speed=2.0))
    problem = replace(corridor(items=items, robots=robots), weights=Weights(robots=10.0))
    found = solve(peer, problem)
    assert found.schedule is not None
    assert check(problem, found.schedule) == []
    assert found.schedule.transfers == 0


def test_infeasible_problem_has_no_schedule(peer: Peer) -> None:
    item = Item("early", 1.0, Visit(2, Window(0.0, 5.0)), Visit(4))
    assert solve(peer, corridor(items=(item,))).status is Status.UNKNOWN


def test_result_is_never_worse_than_the_start(peer: Peer) -> None:
    problem = corridor(items=(parcel(),))
    first = solve(peer, problem)
    again = solve(peer, problem, start=first.schedule)
    assert first.cost is not None
    assert again.cost is not None
    assert again.cost.total <= first.cost.total


def test_what_a_peer_does_not_know_is_refused(peer: Peer) -> None:
    apart = Travel.euclidean([(10.0 * place, 0.0) for place in range(5)])
    doors = Travel.through((Epoch(0.0, 50.0, apart.distance_m, apart.time_s),))
    with pytest.raises(UnsupportedError, match="doors that open and close"):
        solve(peer, replace(corridor(items=(parcel(),)), travel=doors))
    with pytest.raises(UnsupportedError, match="aboard already"):
        solve(peer, corridor(items=(parcel(aboard=0),)))


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the benchmark instances are not here")
def test_published_instance_gets_a_valid_schedule(peer: Peer) -> None:
    problem = read_li_lim(next(DATA.rglob("lc101.txt")).read_text())
    found = peer(problem, seconds=2.0, seed=1, clock=TickingClock())
    assert found.schedule is not None
    assert check(problem, found.schedule) == []
    assert found.cost is not None
    assert found.cost.robots == 10
