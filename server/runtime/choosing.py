"""Which leaf a robot takes next, and the record of why."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.server.journal.events import Candidate
from mend.server.runtime.in_place import in_place_mask
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run_state import RunState
from mend.server.runtime.team import Team
from mend.tasks.potential import leaf_potentials

MAX_RECORDED_CANDIDATES = 100
"""More candidates than this are not journaled; the best are kept."""


@dataclass(frozen=True, slots=True)
class Choice:
    """The chosen leaf and the candidates, best first."""

    leaf: int
    candidates: list[Candidate]


def suitabilities(
    state: RunState, proxy: RobotProxy, leaves: NDArray[np.int64]
) -> NDArray[np.float64]:
    """How well a robot can do each leaf; 0 where it cannot, or another takes that along."""
    nodes = state.tree.nodes
    by_code = np.array([proxy.suitability(each) for each in nodes.behaviors], dtype=np.float64)
    suitable = by_code[nodes.behavior_codes[leaves]]
    robot = proxy.robot
    if state.carriers:
        for number in np.flatnonzero(suitable).tolist():
            entrusted = state.tree.leaf_definition(int(leaves[number])).entrusted
            if entrusted is not None and state.carriers.get(entrusted, robot) != robot:
                suitable[number] = 0.0
    team = proxy.team
    if team is not None and team.shares:
        for number in np.flatnonzero(suitable).tolist():
            if team.leaves_to_others(proxy, state.tree.leaf_definition(int(leaves[number]))):
                suitable[number] = 0.0
    return suitable


def potentials_for(
    state: RunState, proxy: RobotProxy, leaves: NDArray[np.int64]
) -> NDArray[np.float64]:
    """The activation potential of each leaf for a robot: how near objects and places are."""
    last_seen = {name: (each.x, each.y, each.z) for name, each in proxy.seen.items()}
    suitable = suitabilities(state, proxy, leaves)
    return leaf_potentials(
        state.tree.nodes, leaves, last_seen, proxy.gripper, suitable, state.places
    )


def able_mask(state: RunState, proxy: RobotProxy, leaves: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Which of the leaves a robot can do at all and has not tried too often."""
    able: NDArray[np.bool_] = suitabilities(state, proxy, leaves) > 0
    if state.exhausted:
        able &= ~np.isin(leaves, list(state.exhausted))
    return able


def choose(state: RunState, proxy: RobotProxy, *, held: bool = False) -> Choice | None:
    """The leaf that a robot takes next; None if there is none that it can do, or do now.

    `held`: of those that wait to be let go, and else only of the others.
    """
    leaves = state.tree.eligible_leaves()
    able = able_mask(state, proxy, leaves)
    able &= state.steering.held_mask(leaves, state.taken_back) == held
    able &= _with_company_mask(state, proxy, leaves, able)
    in_place = in_place_mask(state, state.tree, proxy.seen, leaves)
    wanted = able & in_place if (able & in_place).any() else able
    if proxy.team is not None and proxy.team.has_company:
        free = _free_mask(state, proxy, proxy.team, leaves, able)
        able, wanted = able & free, wanted & free
    if not wanted.any():
        return None
    preferred = leaves == state.steering.preferred
    if (able & preferred).any():
        wanted = able & preferred
    potentials = potentials_for(state, proxy, leaves)
    leaf = state.tree.choose(leaves, potentials, wanted)
    if leaf is None:
        return None
    candidates = _candidates(state, leaves[able], potentials[able], in_place[able])
    return Choice(leaf, candidates)


def _with_company_mask(
    state: RunState,
    proxy: RobotProxy,
    leaves: NDArray[np.int64],
    able: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """What a robot may do that has met people: as long as it can lead any of them, nothing else."""
    theirs = np.zeros(leaves.size, dtype=np.bool_)
    if state.carriers:
        for number in np.flatnonzero(able).tolist():
            person = state.tree.leaf_definition(int(leaves[number])).person
            theirs[number] = person is not None and state.carriers.get(person) == proxy.robot
    return theirs if theirs.any() else np.ones(leaves.size, dtype=np.bool_)


def _free_mask(
    state: RunState,
    proxy: RobotProxy,
    team: Team,
    leaves: NDArray[np.int64],
    able: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Which of the leaves need no part, no place and no space that another robot has now."""
    theirs = [state.tree.leaf_definition(each.leaf) for each in state.executions.values()]
    used = {name for each in theirs for name in (each.object, each.place) if name is not None}
    used |= team.handled_by_neighbours()
    free = np.zeros(leaves.size, dtype=np.bool_)
    for number in np.flatnonzero(able).tolist():
        leaf = state.tree.leaf_definition(int(leaves[number]))
        free[number] = used.isdisjoint({leaf.object, leaf.place}) and team.may_begin(proxy, leaf)
    return free


def _candidates(
    state: RunState,
    leaves: NDArray[np.int64],
    potentials: NDArray[np.float64],
    in_place: NDArray[np.bool_],
) -> list[Candidate]:
    tree = state.tree
    attempts = tree.attempts_of(leaves)
    # Sorting keeps the tree's order, in which the leaves come, where all else is equal.
    others = leaves != state.steering.preferred
    order = np.lexsort((-potentials, attempts, ~in_place, others))[:MAX_RECORDED_CANDIDATES]
    asked_for = state.steering.next
    return [
        Candidate(
            node=tree.path_of(leaf),
            name=tree.name_of(leaf),
            level=tree.level(leaf),
            potential=potential,
            attempts=failed,
            in_place=there,
            asked_for_by=asked_for[1].by if asked_for and asked_for[0] == leaf else None,
        )
        for leaf, potential, failed, there in zip(
            leaves[order].tolist(),
            potentials[order].tolist(),
            attempts[order].tolist(),
            in_place[order].tolist(),
            strict=True,
        )
    ]
