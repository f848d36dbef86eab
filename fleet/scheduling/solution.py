"""What every solver gives back: a schedule, how good it is, and how good any could be."""

from dataclasses import dataclass
from enum import StrEnum

from mend.fleet.scheduling.objective import Cost, cost
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Schedule


class UnsupportedError(Exception):
    """A solver does not know what a problem asks for; says what, raised before it begins."""


class Status(StrEnum):
    """How far a solver has come."""

    OPTIMAL = "optimal"
    FEASIBLE = "feasible"
    INFEASIBLE = "infeasible"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Progress:
    """The best cost so far and a bound that no schedule can beat (None: none yet)."""

    incumbent: float | None
    bound: float | None
    seconds: float


@dataclass(frozen=True, slots=True)
class Solution:
    """The best schedule found (None where there is none), its cost, and the proved bound."""

    status: Status
    schedule: Schedule | None
    cost: Cost | None
    bound: float | None
    seconds: float

    @property
    def gap(self) -> float | None:
        """How much better than this the optimum could be, as a share of the cost."""
        if self.cost is None or self.bound is None:
            return None
        if self.cost.total <= 0:
            return 0.0
        return max(0.0, (self.cost.total - self.bound) / self.cost.total)


def unproved(problem: Problem, schedule: Schedule | None, seconds: float) -> Solution:
    """What a method gives back that proves nothing: `UNKNOWN` where it has no schedule."""
    if schedule is None:
        return Solution(Status.UNKNOWN, None, None, None, seconds)
    return Solution(Status.FEASIBLE, schedule, cost(problem, schedule), None, seconds)
