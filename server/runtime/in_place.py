"""Leaves that somebody has done unasked: what they handle is seen where it is to be."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mend.dialogue.evidence import MOVED_M, RAISED_M
from mend.robots.link.messages import Sighting
from mend.server.runtime.parting import ancestors
from mend.server.runtime.run_state import RunState
from mend.tasks.definition import NodeKind
from mend.tasks.node_table import NO_CODE
from mend.tasks.task_tree import TaskTree

Leaves = NDArray[np.int64]


def in_place_mask(
    state: RunState, tree: TaskTree, seen: Mapping[str, Sighting], leaves: Leaves
) -> NDArray[np.bool_]:
    """Which of some eligible leaves have their object at its place, in an OR that is still open.

    Only there does it matter which one is begun: another alternative would be done besides, or
    would take that very part away. `tree` is that of the run, or as it is about to be.
    """
    found = np.zeros(leaves.size, dtype=np.bool_)
    places = _places_of(state, tree, seen)
    if not places:
        return found
    handled = np.isin(tree.nodes.object_codes[leaves], list(places))
    for number in np.flatnonzero(handled).tolist():
        leaf = int(leaves[number])
        at = places[int(tree.nodes.object_codes[leaf])]
        found[number] = tree.nodes.text(leaf, "place") in at and _is_open_over(tree, leaf)
    return found


def _places_of(
    state: RunState, tree: TaskTree, seen: Mapping[str, Sighting]
) -> dict[int, set[str]]:
    """The places at which the objects of leaves are seen, by the code of each."""
    names = list(state.spots)
    spots = np.array([*state.spots.values()]).reshape(-1, 3)
    found: dict[int, set[str]] = {}
    for name, each in seen.items():
        code = tree.nodes.object_code(name)
        if code == NO_CODE:
            continue
        off = np.abs(spots - (each.x, each.y, each.z))
        there = (np.hypot(off[:, 0], off[:, 1]) <= MOVED_M) & (off[:, 2] <= RAISED_M)
        if there.any():
            found[code] = {names[index] for index in np.flatnonzero(there).tolist()}
    return found


def _is_open_over(tree: TaskTree, leaf: int) -> bool:
    """Whether an OR above a leaf may still be done by another alternative."""
    return any(
        tree.kind_of(node) is NodeKind.OR and tree.committed(node) is None
        for node in ancestors(tree, leaf)
    )
