"""The ways in which a tree can be done."""

import json

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from trees import BEHAVIORS

from tasks.random_task import random_task
from tasks.task_file import check_task_text
from tasks.ways import leaves_of, ways_of


def definition(tree):
    return check_task_text(json.dumps({"name": "t", "tree": tree}), BEHAVIORS).definition


def leaf(name):
    return {"behavior": "pick_and_place", "object": name, "place": name}


def names(tree):
    return [[each.name for each in way] for way in ways_of(definition(tree))]


def test_a_tree_without_alternatives_has_one_way():
    assert names({"then": [leaf("a"), {"and": [leaf("b"), leaf("c")]}]}) == [["a", "b", "c"]]


def test_of_every_or_a_way_has_one_alternative():
    tree = {"then": [{"or": [leaf("a"), leaf("b")]}, {"or": [leaf("c"), leaf("d")]}]}
    assert sorted(names(tree)) == [["a", "c"], ["a", "d"], ["b", "c"], ["b", "d"]]


@given(st.integers(0, 10**6), st.integers(1, 120))
@settings(max_examples=40, deadline=None)
def test_every_leaf_is_in_some_way_and_the_ways_are_few(seed, count):
    task = random_task(np.random.default_rng(seed), count)
    checked = check_task_text(json.dumps(task), BEHAVIORS).definition
    ways = [{each.name for each in way} for way in ways_of(checked)]
    assert set.union(*ways) == {each.name for each in leaves_of(checked)}
    assert len(ways) <= 64 + count
