"""What a tree takes back when a finished leaf's result is gone: the cases of docs/house.md."""

import pytest
from trees import Written, and_, eligible_names, node_called, or_, running_tree, then

from mend.errors import IllegalTransitionError
from mend.tasks.task_tree import TaskTree


def after(written: Written, *done: str, active: str | None = None) -> TaskTree:
    """A tree in which leaves were done in this order, and perhaps one more started."""
    tree = running_tree(written)
    for name in done:
        tree.start(node_called(tree, name), "r1")
        tree.finish(node_called(tree, name))
    if active is not None:
        tree.start(node_called(tree, active), "r2")
    return tree


def take_back(tree: TaskTree, name: str) -> tuple[list[str], list[str]]:
    """Take a leaf back with all that goes with it: what was put back, and what taken back."""
    found = tree.what_to_take_back(node_called(tree, name))
    for leaf in found.put_back:
        tree.put_back(leaf, failed=False)
    for leaf in found.taken_back:
        tree.take_back(leaf)
    return [tree.name_of(i) for i in found.put_back], [tree.name_of(i) for i in found.taken_back]


def done_names(tree: TaskTree) -> list[str]:
    return [tree.name_of(i) for i in tree.leaves if tree.done(i)]


def test_a_then_takes_back_everything_after_the_leaf_the_last_first() -> None:
    tree = after(then("a", "b", "c", "d"), "a", "b", "c")
    assert take_back(tree, "b") == ([], ["c", "b"])
    assert done_names(tree) == ["a"]
    assert eligible_names(tree) == ["b"]


def test_what_is_active_after_the_leaf_is_put_back_first() -> None:
    tree = after(then("a", "b"), "a", active="b")
    with pytest.raises(IllegalTransitionError, match=r"followed by 'b' \(/1\)"):
        tree.take_back(node_called(tree, "a"))
    assert take_back(tree, "a") == (["b"], ["a"])
    assert eligible_names(tree) == ["a"]


def test_an_and_takes_back_the_leaf_alone() -> None:
    tree = after(and_("a", "b", "c"), "a", "b", active="c")
    assert take_back(tree, "a") == ([], ["a"])
    assert done_names(tree) == ["b"]
    assert eligible_names(tree) == ["a"]


def test_an_and_that_was_done_is_done_no_longer_and_what_follows_it_goes_too() -> None:
    tree = after(then(and_("a", "b"), "c"), "a", "b", "c")
    assert tree.done(0)
    assert take_back(tree, "a") == ([], ["c", "a"])
    assert done_names(tree) == ["b"]
    assert not tree.done(0)
    assert eligible_names(tree) == ["a"]


def test_an_or_opens_again_once_nothing_is_left_under_its_alternative() -> None:
    tree = after(then(or_("a", "b"), "c"), "a", "c")
    take_back(tree, "a")
    assert tree.committed(node_called(tree, "g1")) is None
    assert eligible_names(tree) == ["a", "b"]


def test_an_or_keeps_to_an_alternative_under_which_something_is_still_done() -> None:
    tree = after(or_(then("a", "b"), "c"), "a", "b")
    assert take_back(tree, "b") == ([], ["b"])
    assert eligible_names(tree) == ["b"]
    assert take_back(tree, "a") == ([], ["a"])
    assert eligible_names(tree) == ["a", "c"]


def test_an_abandoned_alternative_stays_abandoned() -> None:
    tree = running_tree(or_("a", "b", "c"))
    tree.abandon(node_called(tree, "a"))
    leaf = node_called(tree, "b")
    tree.start(leaf, "r1")
    tree.finish(leaf)
    take_back(tree, "b")
    assert eligible_names(tree) == ["b", "c"]


def test_nested_orders_each_take_back_what_they_put_after_the_leaf() -> None:
    tree = after(
        then("a", and_(then("b", "c"), then("d", "e")), "f"), "a", "b", "d", "c", "e", active="f"
    )
    assert take_back(tree, "b") == (["f"], ["c", "b"])
    assert done_names(tree) == ["a", "d", "e"]
    assert eligible_names(tree) == ["b"]


def test_failed_attempts_are_kept() -> None:
    tree = running_tree(then("a", "b"))
    leaf = node_called(tree, "a")
    tree.start(leaf, "r1")
    tree.put_back(leaf, failed=True)
    tree.start(leaf, "r1")
    tree.finish(leaf)
    take_back(tree, "a")
    assert tree.attempts(leaf) == 1
    assert tree.owner(leaf) is None


def test_only_what_is_done_can_be_taken_back() -> None:
    tree = after(then("a", "b"), "a", active="b")
    for name in ("b", "g0"):
        with pytest.raises((IllegalTransitionError, ValueError)):
            tree.what_to_take_back(node_called(tree, name))
        with pytest.raises((IllegalTransitionError, ValueError)):
            tree.take_back(node_called(tree, name))
