"""Preparing a method compiles all that it may come to need, before its time begins to count."""

import subprocess
import sys
from pathlib import Path

import pytest

SOLVED_AFTER_PREPARING = """
import sys
method, folder, doubles = sys.argv[1:]
sys.path.append(doubles)
from even_clock import EvenClock
from numba.core.dispatcher import Dispatcher
from mend.fleet.scheduling.methods import METHODS, solve
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights
from mend.fleet.scheduling.travel import Travel

def compiled():
    return {
        (name, value.py_func.__qualname__, str(signature))
        for name, module in list(sys.modules.items())
        if name.startswith(f"mend.fleet.scheduling.{folder}.")
        for value in vars(module).values()
        if isinstance(value, Dispatcher)
        for signature in value.signatures
    }

places = tuple((10.0 * number, float(number % 2)) for number in range(5))
robots = tuple(Robot(f"robot{at}", at, at, 2.0) for at in (0, 2, 4))
ways = ((0, 4), (4, 0), (1, 3), (3, 2))
items = tuple(Item(f"{a} to {b}", 1.0, Visit(a), Visit(b)) for a, b in ways)
transfers = Transfers((1, 2)) if method == "exact" else Transfers()
names = tuple("abcde")
travel = Travel.euclidean(places)
problem = Problem("some", names, travel, robots, items, transfers, Weights(robots=1.0))
METHODS[method].prepare()
before = compiled()
found = solve(problem, method, seconds=20.0, clock=EvenClock())
assert before and found.schedule is not None
print(*sorted(compiled() - before))
"""

DOUBLES = str(Path(__file__).parents[2] / "doubles")


@pytest.mark.slow
@pytest.mark.parametrize(("method", "folder"), [("exact", "exact"), ("alns", "routing")])
def test_nothing_is_left_to_compile_for_a_method_that_is_prepared(method: str, folder: str) -> None:
    left = subprocess.run(
        [sys.executable, "-c", SOLVED_AFTER_PREPARING, method, folder, DOUBLES],
        capture_output=True,
        text=True,
        check=True,
    )
    assert left.stdout.strip() == ""
