"""Why several items cannot all be delivered: as few as clash, and what does not hold together."""

import time
from dataclasses import replace

from delivery_problems import corridor, parcel
from ticking_clock import TickingClock

from mend.fleet.scheduling.exact.infeasible_subset import infeasible_subset_words
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Window
from mend.fleet.scheduling.solution import Status

PATIENCE_S = 600.0
"""More than a proof ever takes, on however busy a machine."""

ONE = (Robot("ada", 0, None, 1.0, Window(0.0, 500.0)),)


def by(name: str, origin: int, destination: int, latest_s: float) -> Item:
    return Item(name, 1.0, Visit(origin), Visit(destination, Window(0.0, latest_s)))


def words(problem: Problem, seconds: float = 60.0) -> str:
    assert (
        solve_exactly(problem, seconds=PATIENCE_S, clock=time.perf_counter).status
        is Status.INFEASIBLE
    )
    return infeasible_subset_words(problem, seconds=seconds, clock=TickingClock(0.01))


def test_only_what_clashes_is_named() -> None:
    items = (by("post", 0, 4, 60.0), parcel("box", 1, 2), by("tea", 2, 0, 50.0))
    told = words(corridor(items=items, robots=ONE, transfers=Transfers()))
    assert told == (
        "items 'post' and 'tea' cannot all be delivered, whatever the robots do; these cannot hold "
        "together: to drop post at e must begin by 60 s; to drop tea at a must begin by 50 s"
    )


def test_capacities_are_named_where_they_bind() -> None:
    items = (by("post", 0, 4, 45.0), by("tea", 0, 4, 45.0))
    told = words(corridor(items=items, robots=ONE, transfers=Transfers()))
    assert told.endswith("; ada carries no more than 1")
    larger = (replace(ONE[0], capacity=2.0),)
    roomy = corridor(items=items, robots=larger, transfers=Transfers())
    assert (
        solve_exactly(roomy, seconds=PATIENCE_S, clock=time.perf_counter).status is Status.OPTIMAL
    )


def test_shifts_are_named_where_they_bind() -> None:
    items = (parcel("post", 0, 4), parcel("tea", 4, 0), parcel("box", 0, 4))
    robots = (replace(ONE[0], shift=Window(0.0, 100.0)),)
    told = words(corridor(items=items, robots=robots, transfers=Transfers()))
    assert told.startswith("items 'post' and 'box' cannot all be delivered")
    assert told.endswith("the shift of ada ends at 100 s; ada carries no more than 1")


def test_everything_is_named_when_the_time_is_over() -> None:
    items = (by("post", 0, 4, 60.0), parcel("box", 1, 2), by("tea", 2, 0, 50.0))
    told = words(corridor(items=items, robots=ONE, transfers=Transfers()), seconds=0.0)
    assert "items 'post', 'box' and 'tea'" in told
    assert "the shift of ada ends at 500 s" in told
