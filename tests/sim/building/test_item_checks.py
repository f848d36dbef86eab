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


def meet(person: str, place: str = "a") -> Tree:
    return ("meet_person", person, place)


def escort(person: str, place: str = "b") -> Tree:
    return ("escort", person, place)


def told(tree: Tree, robots: int = 1) -> list[str]:
    nodes: list[GoalNode | BehaviorNode] = []
    lay_out(tree, None, nodes)
    return [each.message for each in check_items(nodes, robots)]


def lay_out(tree: Tree, parent: int | None, nodes: list[GoalNode | BehaviorNode]) -> None:
    name = f"n{len(nodes)}"
    if isinstance(tree, tuple):
        behavior, item, place = tree
        handled = "person" if behavior in ("meet_person", "escort") else "item"
        parameters = {handled: item, "place": place}
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
        {"then": [meet("Ann"), escort("Ann"), meet("Ann", "c"), escort("Ann", "d")]},
        {"and": [{"then": [meet(each), escort(each)]} for each in ("Ann", "Bo")]},
        {"then": [meet("Ann"), collect("mail"), escort("Ann"), hand_over("mail")]},
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


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        (
            escort("Ann"),
            "'escort_Ann' escorts 'Ann', who may not have been met by then: put a meet_person "
            "with them before it in a THEN",
        ),
        (
            {"then": [meet("Ann"), meet("Ann"), escort("Ann")]},
            "'meet_person_Ann' meets 'Ann', whom a robot may lead by then: put an escort of them "
            "in between",
        ),
        (
            {"then": [meet("Ann"), meet("Bo"), escort("Ann"), escort("Bo")]},
            "'meet_person_Bo' meets 'Bo' while 'Ann' may still be led: put their escort before it",
        ),
    ],
)
def test_people_are_met_and_led_one_at_a_time(tree: Tree, message: str) -> None:
    assert told(tree, robots=2) == [message]


def test_children_of_an_and_do_not_escort_one_person() -> None:
    (message, *_) = told({"and": [meet("Ann"), escort("Ann")]})
    assert message == (
        "several children of the AND 'n0' escort 'Ann', in any order: put them into one THEN"
    )
