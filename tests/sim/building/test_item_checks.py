"""What in the order of a task keeps things from being carried is told in one sentence each."""

from collections.abc import Mapping
from typing import Any

import pytest

from mend.sim.building.item_checks import check_items
from mend.tasks.definition import BehaviorNode, GoalNode

Tree = Mapping[str, Any] | tuple[str, str, str]


def collect(item: str, place: str = "a") -> Tree:
    return ("collect_item", item, place)


def hand_over(item: str, place: str = "b") -> Tree:
    return ("hand_over_item", item, place)


def told(tree: Tree, robots: int = 1) -> list[str]:
    nodes: list[GoalNode | BehaviorNode] = []
    lay_out(tree, None, nodes)
    return [each.message for each in check_items(nodes, robots)]


def lay_out(tree: Tree, parent: int | None, nodes: list[GoalNode | BehaviorNode]) -> None:
    name = f"n{len(nodes)}"
    if isinstance(tree, tuple):
        behavior, item, place = tree
        parameters = {"item": item, "place": place}
        nodes.append(
            BehaviorNode(
                parent=parent,
                name=f"{behavior}_{item}",
                behavior=behavior,
                parameters=dict(parameters),
            )
        )
        return
    ((kind, children),) = tree.items()
    nodes.append(GoalNode(kind=kind, parent=parent, name=name))
    index = len(nodes) - 1
    for child in children:
        lay_out(child, index, nodes)


@pytest.mark.parametrize(
    "tree",
    [
        {"then": [collect("mail"), hand_over("mail")]},
        {"then": [{"and": [collect("mail"), collect("keys")]}, hand_over("mail")]},
        {"then": [{"or": [collect("mail"), collect("mail", "c")]}, hand_over("mail")]},
        {"then": [collect("mail"), hand_over("mail"), collect("mail", "b")]},
        {"and": [{"then": [collect(each), hand_over(each)]} for each in "qrstuvw"]},
        {"or": [collect("mail"), {"then": [collect("mail"), hand_over("mail")]}]},
    ],
)
def test_a_task_that_can_be_carried_out_is_no_problem(tree: Tree) -> None:
    assert told(tree) == []


@pytest.mark.parametrize(
    "tree",
    [
        hand_over("mail"),
        {"then": [hand_over("mail"), collect("mail")]},
        {"then": [collect("keys"), hand_over("mail")]},
        {"then": [{"or": [collect("mail"), collect("keys")]}, hand_over("mail")]},
        {"then": [collect("mail"), hand_over("mail"), hand_over("mail")]},
    ],
)
def test_what_was_never_collected_is_not_handed_over(tree: Tree) -> None:
    (message,) = told(tree)
    assert message == (
        "'hand_over_item_mail' hands over 'mail', which may not have been collected by then: put "
        "a collect_item of it before it in a THEN"
    )


def test_children_of_an_and_do_not_carry_one_thing() -> None:
    (message, *_) = told({"and": [collect("mail"), hand_over("mail")]})
    assert message == (
        "several children of the AND 'n0' carry 'mail', in any order: put them into one THEN"
    )


def test_what_is_in_a_basket_is_not_collected_again() -> None:
    (message,) = told({"then": [collect("mail"), collect("mail")]})
    assert message.endswith(
        "which may be in a basket by then: put a hand_over_item of it in between"
    )


def test_what_was_brought_elsewhere_is_collected_there() -> None:
    (message,) = told({"then": [collect("mail"), hand_over("mail"), collect("mail", "c")]})
    assert message == "'collect_item_mail' collects 'mail' at 'c', but by then it may be at 'b'"


def test_a_basket_holds_four_things_and_those_of_several_robots_more() -> None:
    tree = {"then": [collect(each) for each in "qrstu"]}
    (message,) = told(tree)
    assert message == (
        "'collect_item_u' collects 'u' while robots carry 'q', 'r', 's', 't': there is room "
        "for 4 things in all baskets"
    )
    assert told(tree, robots=2) == []


def test_a_deep_tree_is_checked_as_any_other() -> None:
    tree: Tree = hand_over("mail")
    for _ in range(400):
        tree = {"then": [tree]}
    assert len(told(tree)) == 1
