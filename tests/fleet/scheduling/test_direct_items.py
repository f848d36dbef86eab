"""Items that may not change robots: who plans with them, and who says that it does not."""

from itertools import count

import pytest
from delivery_problems import corridor, parcel

from mend.fleet.scheduling.methods import solve
from mend.fleet.scheduling.problem import Robot
from mend.fleet.scheduling.solution import UnsupportedError

ROBOTS = (Robot("left", 0, 0, 2.0, max_duration_s=100.0), Robot("right", 4, 4, 2.0))
PROBLEM = corridor(items=(parcel(direct=True),), robots=ROBOTS)


def test_auction_brings_it_with_one_robot() -> None:
    ticks = count()
    schedule = solve(PROBLEM, "auction", seconds=1e6, clock=lambda: float(next(ticks))).schedule
    assert schedule is not None
    assert schedule.transfers == 0


@pytest.mark.parametrize("method", ["alns", "exact", "auto"])
def test_methods_that_would_hand_it_over_say_so(method: str) -> None:
    with pytest.raises(UnsupportedError, match="items that may not change robots; auction"):
        solve(PROBLEM, method, seconds=1.0, clock=lambda: 0.0)
