"""Each rule of the task tree by example."""

import numpy as np
import pytest
from sampled import sample
from trees import and_, eligible_names, node_called, or_, running_tree, then

from mend.errors import IllegalTransitionError, NotFoundError
from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition
from mend.tasks.resolution import Resolution
from mend.tasks.task_tree import TaskTree


def test_then_opens_its_children_in_order() -> None:
    tree = running_tree(then("a", "b"))
    assert eligible_names(tree) == ["a"]
    tree.start(1, "pr2")
    assert eligible_names(tree) == []
    tree.finish(1)
    assert eligible_names(tree) == ["b"]


def test_and_shares_its_level_among_the_children_not_done() -> None:
    tree = running_tree(and_("a", "b", "c"))
    assert [tree.level(i) for i in (1, 2, 3)] == [1 / 3] * 3
    tree.start(1, "pr2")
    tree.finish(1)
    assert [tree.level(i) for i in (1, 2, 3)] == [0, 1 / 2, 1 / 2]


def test_or_commits_to_what_was_started_and_a_retry_opens_the_choice_again() -> None:
    tree = running_tree(or_("a", then("b", "c")))
    assert [tree.level(i) for i in (1, 2, 3)] == [1, 1, 1]
    tree.start(3, "pr2")
    assert tree.committed(0) == 2
    assert tree.level(1) == 0
    tree.resolve(3, Resolution.ROBOT_RETRY, helped=True)
    assert tree.committed(0) is None
    assert eligible_names(tree) == ["a", "b"]


def test_or_stays_committed_after_a_retry_when_something_is_done_under_it() -> None:
    tree = running_tree(or_("a", then("b", "c")))
    for leaf in (3, 4):
        tree.start(leaf, "pr2")
        if leaf == 3:
            tree.finish(leaf)
    tree.put_back(4, failed=True)
    assert tree.committed(0) == 2
    assert eligible_names(tree) == ["c"]


def test_potentials_follow_the_table() -> None:
    tree = running_tree(then(and_("a", "b"), or_("c", "d")))
    a, b, c, d = (node_called(tree, name) for name in "abcd")
    leaf_potentials = {a: 3.0, b: 2.0, c: 5.0, d: 7.0}
    assert tree.potentials(leaf_potentials) == [3, 3, 3, 2, 7, 5, 7]
    tree.start(a, "pr2")
    # What is active has nothing to start any more, so it does not count for the AND.
    assert tree.potentials(leaf_potentials) == [2, 2, 3, 2, 7, 5, 7]


def test_levels_are_zero_while_the_run_is_paused() -> None:
    tree = running_tree(and_("a", "b"))
    tree.running = False
    assert tree.levels() == [0, 0, 0]
    assert tree.eligible_leaves().size == 0
    with pytest.raises(IllegalTransitionError, match="idle in a run that is not running"):
        tree.start(1, "pr2")


def test_choice_prefers_fewest_failed_attempts_then_potential_then_order() -> None:
    tree = running_tree(and_("a", "b", "c"))
    everyone = np.array([True, True, True])

    def choose(*potentials: float) -> int | None:
        return tree.choose(tree.eligible_leaves(), np.array(potentials), everyone)

    assert choose(1.0, 2.0, 2.0) == 2
    tree.start(2, "pr2")
    tree.put_back(2, failed=True)
    assert choose(1.0, 2.0, 0.0) == 1
    assert choose(0.0, 9.0, 0.0) == 1


def test_choice_leaves_out_what_the_agent_can_never_do() -> None:
    tree = running_tree(and_("a", "b"))
    leaves = tree.eligible_leaves()
    potentials = np.array([2.0, 0.0])
    assert tree.choose(leaves, potentials, np.array([False, True])) == 2
    assert tree.choose(leaves, potentials, np.array([False, False])) is None


@pytest.mark.parametrize(
    ("resolution", "helped", "done", "active", "attempts"),
    [
        (Resolution.HUMAN_FINISH, True, True, False, 0),
        (Resolution.ROBOT_FINISH, True, False, True, 0),
        (Resolution.COLLAB_FINISH, True, False, True, 0),
        (Resolution.ROBOT_RETRY, True, False, False, 0),
        (Resolution.ROBOT_RETRY, False, False, False, 1),
    ],
)
def test_resolutions(
    resolution: Resolution, helped: bool, done: bool, active: bool, attempts: int
) -> None:
    tree = running_tree(and_("a", "b"))
    tree.start(1, "pr2")
    tree.resolve(1, resolution, helped=helped)
    assert (tree.done(1), tree.active(1), tree.attempts(1)) == (done, active, attempts)
    assert tree.owner(1) == ("pr2" if active else None)


def test_giving_up_abandons_the_nearest_alternative_with_nothing_done() -> None:
    tree = running_tree(or_(and_("a", "b"), "c"))
    for leaf in (2, 3):
        tree.start(leaf, f"robot{leaf}")
    give_up = tree.give_up(3)
    assert give_up is not None
    assert (give_up.alternative, give_up.put_back) == (1, (2, 3))
    for leaf in give_up.put_back:
        tree.put_back(leaf, failed=False)
    tree.abandon(give_up.alternative)
    assert eligible_names(tree) == ["c"]
    assert tree.abandoned(2)


def test_giving_up_climbs_past_an_alternative_with_something_done() -> None:
    tree = running_tree(or_(then("a", or_(then("b", "c"), "d")), "e"))
    for name in "ab":
        tree.start(node_called(tree, name), "pr2")
        tree.finish(node_called(tree, name))
    assert tree.give_up(node_called(tree, "c")) is None


def test_giving_up_fails_the_run_without_another_alternative() -> None:
    tree = running_tree(or_("a", "b"))
    tree.abandon(1)
    assert tree.give_up(2) is None
    assert running_tree(then("a")).give_up(1) is None


@pytest.mark.parametrize(
    ("transition", "message"),
    [
        (
            lambda tree: tree.finish(1),
            r"'a' \(/0\) is an idle behavior node: expected it to be active, but 'finish' came",
        ),
        (lambda tree: tree.put_back(1, failed=True), "expected it to be active"),
        (lambda tree: tree.start(2, "pr2"), "is idle with level 0: expected it to be eligible"),
        (lambda tree: tree.abandon(1), "expected it to be an alternative of an OR"),
        (
            lambda tree: tree.resolve(1, Resolution.HUMAN_FINISH, helped=True),
            "expected it to be active",
        ),
    ],
)
def test_illegal_transitions_say_what_was_expected_and_what_came(transition, message) -> None:
    with pytest.raises(IllegalTransitionError, match=message):
        transition(running_tree(then("a", "b")))


def test_a_leaf_cannot_be_started_twice_nor_after_it_is_done() -> None:
    tree = running_tree(and_("a", "b"))
    tree.start(1, "pr2")
    with pytest.raises(IllegalTransitionError, match="active \\(held by pr2\\)"):
        tree.start(1, "baxter")
    tree.finish(1)
    with pytest.raises(IllegalTransitionError, match="is done: expected"):
        tree.start(1, "pr2")


def test_an_alternative_under_which_something_is_active_cannot_be_abandoned() -> None:
    tree = running_tree(or_("a", "b"))
    tree.start(1, "pr2")
    with pytest.raises(IllegalTransitionError):
        tree.abandon(1)


def test_a_goal_node_is_no_leaf() -> None:
    with pytest.raises(ValueError, match="is a goal node, not a leaf"):
        running_tree(then("a")).start(0, "pr2")


def test_paths_lead_to_nodes_and_back() -> None:
    tree = running_tree(then("a", or_("b", and_("c", "d"))))
    assert [tree.path_of(i) for i in range(len(tree))] == [
        "/", "/0", "/1", "/1/0", "/1/1", "/1/1/0", "/1/1/1",
    ]  # fmt: skip
    assert [tree.index_of(tree.path_of(i)) for i in range(len(tree))] == list(range(len(tree)))


@pytest.mark.parametrize("path", ["", "0", "/2", "/0/0", "/x", "/-1", "/01", "//", "/1/"])
def test_a_path_to_nowhere_is_refused(path: str) -> None:
    with pytest.raises(NotFoundError):
        running_tree(then("a", or_("b", "c"))).index_of(path)


def chain(depth: int, kind: str) -> TaskTreeDefinition:
    """Goal nodes inside one another, each with a leaf beside the next."""
    nodes: list[GoalNode | BehaviorNode] = []
    parent: int | None = None
    for level in range(depth):
        fields = {"kind": kind, "parent": parent, "name": f"g{level}"}
        nodes.append(GoalNode.model_validate(fields))
        parent = len(nodes) - 1
        nodes.append(BehaviorNode(parent=parent, name=f"l{level}", behavior="wait"))
    return TaskTreeDefinition(name="chain", nodes=nodes)


def test_a_deep_tree_runs_and_its_levels_never_vanish() -> None:
    definition = chain(6_000, "and")
    tree = TaskTree(TaskTreeDefinition.model_validate(definition.to_json()))
    tree.running = True
    deepest = tree.leaves[-1]
    assert tree.level(deepest) > 0
    assert min(tree.levels()) > 0
    assert len(tree.eligible_leaves()) == 6_000
    tree.start(deepest, "pr2")
    tree.finish(deepest)
    assert tree.index_of(tree.path_of(deepest)) == deepest
    assert not tree.done(0)


@pytest.mark.slow
def test_very_many_nodes_run_to_the_end_of_a_branch() -> None:
    branches = sample(200, 1_000)
    nodes: list[GoalNode | BehaviorNode] = [GoalNode(kind="and", parent=None, name="root")]
    for branch in range(branches):
        parent = len(nodes)
        nodes.append(GoalNode(kind="then", parent=0, name=f"g{branch}"))
        nodes.extend(
            BehaviorNode(parent=parent, name=f"l{branch}_{i}", behavior="wait") for i in range(99)
        )
    definition = TaskTreeDefinition(name="large", nodes=nodes)
    tree = TaskTree(TaskTreeDefinition.model_validate(definition.to_json()))
    tree.running = True
    assert len(tree) == 100 * branches + 1
    for leaf in range(2, 101):
        assert leaf in tree.eligible_leaves()
        tree.start(leaf, "pr2")
        tree.finish(leaf)
    assert tree.done(1)
    assert len(tree.eligible_leaves()) == branches - 1


@pytest.mark.parametrize(
    ("parents", "message"),
    [
        ([None, None], "must have a child"),
        ([None, 0, 1], "must follow its parent"),
        ([0, 0], "must not have a parent"),
    ],
)
def test_a_definition_must_be_one_tree_in_order(parents: list[int | None], message: str) -> None:
    root = {"kind": "then", "parent": parents[0], "name": "n0"}
    rest = [
        {"kind": "behavior", "parent": parent, "name": f"n{i}", "behavior": "wait"}
        for i, parent in enumerate(parents[1:], start=1)
    ]
    with pytest.raises(ValueError, match=message):
        TaskTreeDefinition.model_validate({"name": "t", "nodes": [root, *rest]})


def test_a_definition_refuses_an_empty_goal_node_and_a_name_given_twice() -> None:
    root = {"kind": "then", "parent": None, "name": "n0"}
    leaf = {"kind": "behavior", "parent": 0, "name": "n0", "behavior": "wait"}
    with pytest.raises(ValueError, match="must have a child"):
        TaskTreeDefinition.model_validate({"name": "t", "nodes": [root]})
    with pytest.raises(ValueError, match="both called 'n0'"):
        TaskTreeDefinition.model_validate({"name": "t", "nodes": [root, leaf]})


def test_a_copy_goes_its_own_way() -> None:
    tree = running_tree(then(or_("a", "b"), "c"))
    a, b, c = (node_called(tree, name) for name in "abc")
    tree.start(a, "pr2")
    copied = tree.copy()
    copied.put_back(a, failed=True)
    copied.abandon(a)
    copied.start(b, "other")
    copied.finish(b)
    assert copied.eligible_leaves().tolist() == [c]
    assert (copied.attempts(a), copied.abandoned(a), copied.done(b)) == (1, True, True)
    assert (tree.attempts(a), tree.abandoned(a), tree.done(b)) == (0, False, False)
    assert tree.active_leaves() == [a]
    assert (tree.owner(a), tree.eligible_leaves().size) == ("pr2", 0)
    tree.finish(a)
    assert tree.eligible_leaves().tolist() == [c]


def test_finished_objects_are_those_of_done_leaves_alone() -> None:
    leaves = [
        BehaviorNode(parent=0, name=f"n{i}", behavior="bring", parameters=parameters)
        for i, parameters in enumerate(({"object": "cup"}, {"object": "pot"}, {}))
    ]
    root = GoalNode(kind="and", parent=None, name="all")
    tree = TaskTree(TaskTreeDefinition(name="t", nodes=[root, *leaves]))
    tree.running = True
    for leaf in (1, 3):
        tree.start(leaf, "pr2")
        tree.finish(leaf)
    assert tree.finished_objects() == {"cup"}
