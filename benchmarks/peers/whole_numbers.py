"""A problem in whole numbers, as the public solvers take it."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.problem import Problem, Window
from mend.fleet.scheduling.solution import UnsupportedError
from mend.fleet.scheduling.travel import Matrix

SCALE = 1000
"""Times and distances are thousandths; times are rounded up, so that what fits then fits."""
LARGEST = 4_000_000_000
"""What fits into 32 bits without a sign, which is what one of the solvers has."""

IntMatrix = NDArray[np.int64]


class WholeNumbers:
    """Matrices with one more place at the end, `anywhere`: it is reached at once from all."""

    def __init__(self, problem: Problem, solver: str) -> None:
        if problem.travel.epochs:
            raise UnsupportedError(f"{solver} cannot plan with doors that open and close")
        if any(item.aboard is not None for item in problem.items):
            raise UnsupportedError(f"{solver} cannot plan for items that are aboard already")
        self.anywhere = len(problem.places)
        weighted = problem.weights.distance * problem.travel.distance_m
        self.cost = self._with_anywhere(np.rint(weighted * SCALE))
        self.horizon = self._find_horizon(problem)
        self._time_s = problem.travel.time_s

    def time(self, speed: float) -> IntMatrix:
        """Travel times at a speed."""
        return self._with_anywhere(np.ceil(self._time_s / speed * SCALE - 1e-6))

    def window(self, window: Window) -> tuple[int, int]:
        """A window, cut at the horizon."""
        latest = int(window.latest_s * SCALE + 1e-6) if isfinite(window.latest_s) else self.horizon
        return int(np.ceil(window.earliest_s * SCALE - 1e-6)), min(latest, self.horizon)

    def end(self, end: int | None) -> int:
        """Where a robot ends."""
        return self.anywhere if end is None else end

    def _with_anywhere(self, numbers: Matrix) -> IntMatrix:
        count = len(numbers)
        whole = np.full((count + 1, count + 1), LARGEST // 4, dtype=np.int64)
        whole[:count, :count] = np.minimum(numbers, LARGEST // 4)
        whole[:, count] = 0
        return whole

    def _find_horizon(self, problem: Problem) -> int:
        """A time by which everything is over."""
        visits = [visit for item in problem.items for visit in (item.pickup, item.delivery)]
        finite = problem.travel.time_s[np.isfinite(problem.travel.time_s)]
        slowest = min(robot.speed for robot in problem.robots)
        last_s = max((visit.window.earliest_s for visit in visits), default=0.0)
        last_s += max(robot.shift.earliest_s for robot in problem.robots)
        last_s += sum(visit.service_s for visit in visits)
        last_s += (len(visits) + 2) * float(finite.max(initial=0.0)) / slowest
        shifts = [robot.shift.latest_s for robot in problem.robots]
        return min(LARGEST // 2, int(min(last_s, max(shifts)) * SCALE) + 1)
