"""Where the ways to many leaves part from the way to one is as when each pair is looked at."""

from itertools import product

import numpy as np
from full_evaluation import Node, define, trees
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.server.runtime.parting import Parting
from mend.tasks.definition import NodeKind
from mend.tasks.task_tree import TaskTree


def _lowest_over(tree: TaskTree, one: int, other: int) -> int:
    """The lowest node over two leaves."""
    above: set[int | None] = set()
    node: int | None = one
    while node is not None:
        above.add(node)
        node = tree.parent_of(node)
    node = other
    while node not in above:
        assert node is not None, "all are under the root"
        node = tree.parent_of(node)
    assert node is not None, "all are under the root"
    return node


def _exclude(tree: TaskTree, one: int, other: int) -> bool:
    return tree.kind_of(_lowest_over(tree, one, other)) is NodeKind.OR


@settings(max_examples=sample(50, 150), deadline=None)
@given(root=trees(), data=st.data())
def test_partings_are_those_of_each_pair(root: Node, data: st.DataObject) -> None:
    tree = TaskTree(define(root))
    leaf = data.draw(st.sampled_from(list(tree.leaves)))
    rest = [each for each in tree.leaves if each != leaf]
    others = sorted(data.draw(st.sets(st.sampled_from(rest)))) if rest else []
    parting = Parting(tree, leaf, np.array(others, dtype=np.int64))
    assert parting.at_or.tolist() == [_exclude(tree, each, leaf) for each in others]
    # Whether a leaf that excludes this one excludes another one that does not.
    rivals = [i for i, each in enumerate(parting.at_or) if each]
    friends = [i for i, each in enumerate(parting.at_or) if not each]
    for rival, friend in product(rivals, friends):
        higher = bool(parting.height[friend] < parting.height[rival])
        assert higher == _exclude(tree, others[friend], others[rival])
