"""Random trees of goal nodes in which an order of the leaves is kept."""

from collections.abc import Mapping, Sequence, Set
from itertools import pairwise
from typing import Any

import numpy as np

_DEEPEST = 8
_MOST_CHILDREN = 6


def random_ordered_nesting(
    rng: np.random.Generator, leaves: Mapping[str, dict[str, Any]], order: Set[tuple[str, str]]
) -> dict[str, Any]:
    """A tree of THEN and AND over all leaves; of each pair in `order` the first one is done first.

    Raises `ValueError` where the order contradicts itself.
    """

    def grow(names: Sequence[str], depth: int) -> dict[str, Any]:
        if len(names) == 1:
            return leaves[names[0]]
        groups = _independent_groups(names, order)
        most = min(len(names), _MOST_CHILDREN)
        if depth >= _DEEPEST:
            return {"then": [leaves[name] for name in _line_up(rng, names, order)]}
        if len(groups) > 1 and rng.random() < 0.6:
            shares = _share_out(rng, groups, min(len(groups), most))
            return {"and": [grow(share, depth + 1) for share in shares]}
        line = _line_up(rng, names, order)
        children = int(rng.integers(2, most + 1))
        cuts = np.sort(rng.choice(np.arange(1, len(line)), size=children - 1, replace=False))
        ends = [0, *(int(cut) for cut in cuts), len(line)]
        return {"then": [grow(line[begin:end], depth + 1) for begin, end in pairwise(ends)]}

    return grow(list(leaves), 0)


def _independent_groups(names: Sequence[str], order: Set[tuple[str, str]]) -> list[list[str]]:
    """The names in groups between which no order holds."""
    group = {name: [name] for name in names}
    for first, then in sorted(order):
        if first in group and then in group and group[first] is not group[then]:
            group[first] += group[then]
            for name in group[then]:
                group[name] = group[first]
    return [group[name] for name in names if group[name][0] == name]


def _share_out(rng: np.random.Generator, groups: Sequence[list[str]], most: int) -> list[list[str]]:
    """The groups in 2 to `most` shares, none empty."""
    count = int(rng.integers(2, most + 1))
    shares: list[list[str]] = [[] for _ in range(count)]
    for number, index in enumerate(rng.permutation(len(groups))):
        share = number if number < count else int(rng.integers(count))
        shares[share] += groups[int(index)]
    return shares


def _line_up(
    rng: np.random.Generator, names: Sequence[str], order: Set[tuple[str, str]]
) -> list[str]:
    """The names in any line that keeps the order. Raises `ValueError` where there is none."""
    waiting, line = list(names), []
    while waiting:
        held_up = {then for first, then in order if first in waiting}
        free = [name for name in waiting if name not in held_up]
        if not free:
            raise ValueError(f"the order of {', '.join(waiting)} contradicts itself")
        line.append(free[int(rng.integers(len(free)))])
        waiting.remove(line[-1])
    return line
