"""The ways in which a task tree can be done: of every OR, one alternative."""

import itertools
import math
import random
from collections.abc import Iterator

from tasks.definition import BehaviorNode, TaskTreeDefinition

_MOST_WAYS = 64


def leaves_of(tree: TaskTreeDefinition) -> list[BehaviorNode]:
    """All leaves, in their order."""
    return [node for node in tree.nodes if isinstance(node, BehaviorNode)]


def ways_of(tree: TaskTreeDefinition) -> Iterator[list[BehaviorNode]]:
    """The leaves of one way after another.

    All ways where there are at most `_MOST_WAYS`; else some in which every alternative occurs.
    """
    alternatives = _alternatives(tree)
    if math.prod(len(each) for each in alternatives.values()) <= _MOST_WAYS:
        for chosen in itertools.product(*alternatives.values()):
            yield _way(tree, set(chosen))
        return
    chance = random.Random(0)
    seen: set[int] = set()
    for wanted in itertools.chain(*alternatives.values(), [None] * _MOST_WAYS):
        if wanted not in seen:
            some = {parent: chance.choice(each) for parent, each in alternatives.items()}
            some |= _choices_over(tree, wanted)
            seen |= _kept(tree, set(some.values()))
            yield _way(tree, set(some.values()))


def _choices_over(tree: TaskTreeDefinition, node: int | None) -> dict[int, int]:
    """What to choose at each OR above a node so that it is in the way."""
    choices: dict[int, int] = {}
    while node is not None and (parent := tree.nodes[node].parent) is not None:
        if tree.nodes[parent].kind == "or":
            choices[parent] = node
        node = parent
    return choices


def _alternatives(tree: TaskTreeDefinition) -> dict[int, list[int]]:
    """The children of every OR."""
    children: dict[int, list[int]] = {}
    for index, node in enumerate(tree.nodes):
        if node.parent is not None and tree.nodes[node.parent].kind == "or":
            children.setdefault(node.parent, []).append(index)
    return children


def _way(tree: TaskTreeDefinition, chosen: set[int]) -> list[BehaviorNode]:
    """The leaves that are under chosen alternatives only."""
    kept = _kept(tree, chosen)
    return [
        node
        for index, node in enumerate(tree.nodes)
        if index in kept and isinstance(node, BehaviorNode)
    ]


def _kept(tree: TaskTreeDefinition, chosen: set[int]) -> set[int]:
    """The nodes that are under chosen alternatives only."""
    kept: set[int] = set()
    for index, node in enumerate(tree.nodes):
        if node.parent is None or (
            node.parent in kept and (tree.nodes[node.parent].kind != "or" or index in chosen)
        ):
            kept.add(index)
    return kept
