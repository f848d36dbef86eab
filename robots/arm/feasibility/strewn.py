"""What is possible but for the scatter: of which parts that is so, and how much would fit."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from mend.robots.arm.feasibility.standing import Standing
from mend.tasks.scene import Scatter
from mend.tasks.scene_problem import SceneProblem

_SHARES = 8
"""More scatter may be possible where less is not: what is told is the first that is not, so far."""
_HALVINGS = 5
_MOST_NAMED = 12
_AT_ONCE: Mapping[tuple[str, ...], tuple[str, ...]] = MappingProxyType(
    {("scatter", "xy"): ("xy",), ("scatter", "yaw"): ("yaw",), ("scatter",): ("xy", "yaw")}
)
"""What of a scatter is made smaller: the way, where that is enough, else the turn, else both."""
_STEPS = MappingProxyType({"xy": 0.001, "yaw": 0.01})
"""What is told is rounded down to these, in metres and radians."""


@dataclass(frozen=True, slots=True)
class StrewnPart(SceneProblem):
    """A part that a scatter may put where it cannot be taken, and that could be with what `fits`.

    `possible` tells whether it could with another scatter.
    """

    start: Standing
    scatter: Scatter
    fits: Scatter
    possible: Callable[[Scatter], bool]


def strewn_part(
    start: Standing, scatter: Scatter, possible: Callable[[Scatter], bool]
) -> StrewnPart | None:
    """A part that could be taken but for the scatter; None if it could not without either."""
    for where, keys in _AT_ONCE.items():
        if any(getattr(scatter, key) == 0.0 for key in keys):
            continue
        if possible(_less(scatter, keys, 0.0)):
            fits = _most_that_fits(scatter, keys, possible)
            return StrewnPart(
                where,
                _sentence(where, scatter, {start.name: fits}, start, fits),
                start,
                scatter,
                fits,
                possible,
            )
    return None


def told_together(found: Sequence[StrewnPart]) -> list[SceneProblem]:
    """One sentence for all parts for which the same has to be smaller, and what fits all."""
    told: list[SceneProblem] = []
    for where in dict.fromkeys(each.where for each in found):
        of_it = [each for each in found if each.where == where]
        if len(of_it) == 1:
            told.append(SceneProblem(where, of_it[0].message))
            continue
        share = 1.0
        for key in _AT_ONCE[where]:
            least = min(float(getattr(each.fits, key)) for each in of_it)
            share = min(share, least / getattr(of_it[0].scatter, key))
        scatter = of_it[0].scatter
        for_all = _all_fit(scatter, _AT_ONCE[where], share, of_it)
        fits = {each.start.name: each.fits for each in of_it}
        told.append(SceneProblem(where, _sentence(where, scatter, fits, None, for_all)))
    return told


def _all_fit(
    scatter: Scatter, keys: Sequence[str], share: float, parts: Sequence[StrewnPart]
) -> Scatter:
    """A scatter with which each of some parts could be taken."""
    while share > 0.0:
        smaller = _less(scatter, keys, share)
        if all(each.possible(smaller) for each in parts):
            return smaller
        share = max(0.0, share - 1.0 / _SHARES)
    return _less(scatter, keys, 0.0)


def _most_that_fits(
    scatter: Scatter, keys: Sequence[str], possible: Callable[[Scatter], bool]
) -> Scatter:
    fits, fails = 0.0, 1.0
    for number in range(1, _SHARES + 1):
        if not possible(_less(scatter, keys, number / _SHARES)):
            fits, fails = (number - 1) / _SHARES, number / _SHARES
            break
    for _ in range(_HALVINGS):
        half = (fits + fails) / 2
        if possible(_less(scatter, keys, half)):
            fits = half
        else:
            fails = half
    rounded = _less(scatter, keys, fits)
    while fits > 0.0 and not possible(rounded):
        fits = max(0.0, fits - 1.0 / _SHARES)
        rounded = _less(scatter, keys, fits)
    return rounded


def _less(scatter: Scatter, keys: Sequence[str], share: float) -> Scatter:
    """A share of a scatter, rounded down as it is told."""
    smaller = {}
    for key in keys:
        step = _STEPS[key]
        smaller[key] = round(math.floor(share * getattr(scatter, key) / step + 1e-6) * step, 4)
    return scatter.model_copy(update=smaller)


def _sentence(
    where: tuple[str, ...],
    scatter: Scatter,
    fits: Mapping[str, Scatter],
    alone: Standing | None,
    for_all: Scatter,
) -> str:
    keys = _AT_ONCE[where]
    each = [f"{name} could be taken with {_amount(most, keys)}" for name, most in fits.items()]
    more = f", and {len(each) - _MOST_NAMED} more" if len(each) > _MOST_NAMED else ""
    could = ", ".join(each[:_MOST_NAMED]) + more
    verb = "turn" if keys == ("yaw",) else "put"
    if alone is not None:
        name, pose = alone.name, alone.pose
        return (
            f"a scatter of {_amount(scatter, keys)} may {verb} {name} where the arm cannot take "
            f"it: make it smaller ({could}), or move {name}, which is at ({pose.x:.3f}, "
            f"{pose.y:.3f})"
        )
    return (
        f"a scatter of {_amount(scatter, keys)} may {verb} {len(fits)} parts where the arm cannot "
        f"take them: make it smaller ({could}; all of them with {_amount(for_all, keys)}), or move "
        "them"
    )


def _amount(scatter: Scatter, keys: Sequence[str]) -> str:
    amounts = {"xy": f"{1e3 * scatter.xy:g} mm", "yaw": f"{scatter.yaw:g} rad"}
    return " and ".join(amounts[key] for key in keys)
