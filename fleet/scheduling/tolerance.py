"""How much rounding is forgiven: every solver, the timing and the checker take it from here.

Whatever judges forgives ten times as much as what it judges: what the search takes for possible the
timing can time, and what is timed the checker passes.
"""

from typing import Final

CHECK_S: Final = 1e-6
"""What the checker forgives, and what a relaxation leaves open (seconds)."""
TIMING_S: Final = 1e-7
"""What a temporal network forgives a chain that just fits (seconds)."""
SEARCH_S: Final = 1e-8
"""What a search forgives when it looks for a place in a route (seconds)."""
DOOR_S: Final = 5e-7
"""What is forgiven a robot that just reaches a door: more than its times are rounded by (s)."""
LOAD: Final = 1e-9
"""What is forgiven a full load."""
LENGTH_M: Final = 1e-6
"""A way that is shorter by less is not shorter (metres)."""
COST: Final = 1e-9
"""Costs that differ by less are the same to one who compares many plans of one problem."""
WHOLE: Final = 1e-6
"""How far from a whole number something may be and still count as one."""
SHARE: Final = 1e-6
"""The share by which a solver of linear programs may be wrong."""


def error(cost: float) -> float:
    """By how much a solver of linear programs may be wrong about such a cost."""
    return SHARE * (1.0 + abs(cost))


def safe_bound(proved: float) -> float:
    """What certainly no schedule costs less than, of a bound that a linear program gave."""
    return proved - error(proved)


def proves(bound: float, cost: float) -> bool:
    """Whether a safe bound says that a cost is the least: it may lie below it by what was taken off
    to make it safe, and by the error itself."""
    return bound >= cost - 2.0 * error(cost)
