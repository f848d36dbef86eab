"""Random task files, for trying everything at once."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

GOALS = ("then", "and", "or")

_DEEPEST = 8
_MOST_CHILDREN = 6


def random_task(rng: np.random.Generator, leaves: int) -> dict[str, Any]:
    """A task document in the compact form with `leaves` leaves and every kind of nesting.

    Each leaf handles an object of its own. A fifth of the leaves need help.
    """
    if leaves < 1:
        raise ValueError(f"a task has 1 or more leaves, not {leaves}")
    nodes = [_random_leaf(rng, number) for number in range(1, leaves + 1)]
    return {"name": "random_task", "tree": random_nesting(rng, nodes)}


def random_nesting(
    rng: np.random.Generator, leaves: Sequence[dict[str, Any]], goals: Sequence[str] = GOALS
) -> dict[str, Any]:
    """A tree of goal nodes of the kinds in `goals` over leaves, which stay in their order."""

    def grow(some: Sequence[dict[str, Any]], depth: int) -> dict[str, Any]:
        if len(some) == 1 and (depth > 0 or rng.random() < 0.5):
            return some[0]
        kind = goals[int(rng.integers(len(goals)))]
        if len(some) == 1:
            return {kind: [some[0]]}
        most = min(len(some), _MOST_CHILDREN)
        children = int(rng.integers(2, most + 1)) if depth < _DEEPEST else len(some)
        cuts = np.sort(rng.choice(np.arange(1, len(some)), size=children - 1, replace=False))
        ends = [0, *(int(cut) for cut in cuts), len(some)]
        shares = [some[begin:end] for begin, end in pairwise(ends)]
        return {kind: [grow(share, depth + 1) for share in shares]}

    return grow(leaves, 0)


def _random_leaf(rng: np.random.Generator, number: int) -> dict[str, Any]:
    node: dict[str, Any] = {
        "behavior": "pick_and_place",
        "object": f"part_{number}",
        "place": f"spot_{number}",
    }
    if rng.random() < 0.2:
        node["needs_help"] = True
    return node
