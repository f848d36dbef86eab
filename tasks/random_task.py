"""Random task files, for trying everything at once."""

from typing import Any

import numpy as np

_KINDS = ("then", "and", "or")


def random_task(rng: np.random.Generator, leaves: int) -> dict[str, Any]:
    """A task document in the compact form with `leaves` leaves and every kind of nesting.

    Each leaf handles an object of its own; alternatives of an OR may share one. A fifth of the
    leaves need help.
    """
    if leaves < 1:
        raise ValueError(f"a task has 1 or more leaves, not {leaves}")
    parts = iter(range(1, leaves + 1))

    def leaf() -> dict[str, Any]:
        number = next(parts)
        node: dict[str, Any] = {
            "behavior": "pick_and_place",
            "object": f"part_{number}",
            "place": f"spot_{number}",
        }
        if rng.random() < 0.2:
            node["needs_help"] = True
        return node

    def grow(budget: int, depth: int) -> dict[str, Any]:
        if budget == 1 and (depth > 0 or rng.random() < 0.5):
            return leaf()
        kind = _KINDS[int(rng.integers(len(_KINDS)))]
        if budget == 1:
            return {kind: [leaf()]}
        children = int(rng.integers(2, min(budget, 6) + 1)) if depth < 8 else budget
        cuts = np.sort(rng.choice(np.arange(1, budget), size=children - 1, replace=False))
        shares = np.diff(np.concatenate([[0], cuts, [budget]]))
        return {kind: [grow(int(share), depth + 1) for share in shares]}

    return {"name": "random_task", "tree": grow(leaves, 0)}
