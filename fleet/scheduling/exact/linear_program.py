"""A mixed integer linear program as it grows, and what HiGHS proves of it."""

from collections.abc import Mapping
from math import inf, isfinite

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_array

INFEASIBLE = 2
"""SciPy's status of a program that no values satisfy."""


class LinearProgram:
    """Variables and rows; everything is minimized."""

    def __init__(self) -> None:
        self._cost: list[float] = []
        self._low: list[float] = []
        self._high: list[float] = []
        self._whole: list[int] = []
        self._entries: list[tuple[int, int, float]] = []
        self._row_low: list[float] = []
        self._row_high: list[float] = []

    def variable(self, low: float, high: float, *, cost: float = 0.0, whole: bool = False) -> int:
        """A new variable between bounds; returns its number."""
        self._cost.append(cost)
        self._low.append(low)
        self._high.append(high)
        self._whole.append(int(whole))
        return len(self._cost) - 1

    def low(self, variable: int) -> float:
        """The least value of a variable."""
        return self._low[variable]

    def high(self, variable: int) -> float:
        """The greatest value of a variable."""
        return self._high[variable]

    def row(self, terms: Mapping[int, float], low: float = -inf, high: float = inf) -> None:
        """The sum of these variables times these factors is between bounds."""
        number = len(self._row_low)
        self._entries.extend((number, variable, factor) for variable, factor in terms.items())
        self._row_low.append(low)
        self._row_high.append(high)

    def bound(self, seconds: float) -> float | None:
        """What no values can cost less than, as far as `seconds` suffice to prove it.

        Infinite where there are no values at all.
        """
        shape = (len(self._row_low), len(self._cost))
        rows, columns, factors = zip(*self._entries, strict=True)
        matrix = csr_array((factors, (rows, columns)), shape=shape)
        result = milp(
            np.array(self._cost),
            integrality=np.array(self._whole),
            bounds=Bounds(np.array(self._low), np.array(self._high)),
            constraints=LinearConstraint(matrix, np.array(self._row_low), np.array(self._row_high)),
            options={"time_limit": seconds},
        )
        if result.status == INFEASIBLE:
            return inf
        proved = getattr(result, "mip_dual_bound", None)
        return float(proved) if proved is not None and isfinite(proved) else None
