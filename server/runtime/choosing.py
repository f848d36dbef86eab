"""Which leaf a robot takes next, and the record of why."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from server.journal.events import Candidate
from server.runtime.robot_side import RobotSide
from server.runtime.run_state import RunState
from tasks.potential import leaf_potential

MAX_RECORDED_CANDIDATES = 100
"""More candidates than this are not journaled; the best are kept."""


@dataclass(frozen=True, slots=True)
class Choice:
    """The chosen leaf and the candidates, best first."""

    leaf: int
    candidates: list[Candidate]


def potentials_for(
    state: RunState, side: RobotSide, leaves: NDArray[np.int64]
) -> NDArray[np.float64]:
    """The activation potential of each leaf for a robot, from where it last saw the objects."""
    last_seen = {name: (each.x, each.y, each.z) for name, each in side.seen.items()}
    tree = state.tree
    return np.array(
        [
            leaf_potential(
                tree.leaf_definition(int(leaf)).object,
                last_seen,
                side.gripper,
                side.suitability(tree.leaf_definition(int(leaf)).behavior),
            )
            for leaf in leaves
        ],
        dtype=np.float64,
    )


def able_mask(state: RunState, side: RobotSide, leaves: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Which of the leaves a robot can do at all and has not tried too often."""
    return np.array(
        [
            int(leaf) not in state.exhausted
            and side.suitability(state.tree.leaf_definition(int(leaf)).behavior) > 0
            for leaf in leaves
        ],
        dtype=np.bool_,
    )


def choose(state: RunState, side: RobotSide) -> Choice | None:
    """The leaf that a robot takes next; None if there is none that it can do."""
    leaves = state.tree.eligible_leaves()
    able = able_mask(state, side, leaves)
    if not able.any():
        return None
    potentials = potentials_for(state, side, leaves)
    leaf = state.tree.choose(leaves, potentials, able)
    if leaf is None:
        return None
    return Choice(leaf, _candidates(state, leaves[able], potentials[able]))


def _candidates(
    state: RunState, leaves: NDArray[np.int64], potentials: NDArray[np.float64]
) -> list[Candidate]:
    tree = state.tree
    order = sorted(
        range(len(leaves)),
        key=lambda i: (tree.attempts(int(leaves[i])), -potentials[i], int(leaves[i])),
    )
    return [
        Candidate(
            node=tree.path_of(int(leaves[i])),
            name=tree.name_of(int(leaves[i])),
            level=tree.level(int(leaves[i])),
            potential=float(potentials[i]),
            attempts=tree.attempts(int(leaves[i])),
        )
        for i in order[:MAX_RECORDED_CANDIDATES]
    ]
