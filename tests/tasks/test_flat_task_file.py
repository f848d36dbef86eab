"""The published flat form of task files."""

from typing import Any

import pytest
import yaml
from trees import BEHAVIORS

from mend.documents.problem import InvalidFileError
from mend.tasks.task_file import check_task_text
from mend.tasks.task_tree import TaskTree

Nodes = dict[str, dict[str, Any]]


def entry(kind: int, parent: str, *children: str, robot: int = 0, **more: Any) -> dict[str, Any]:
    mask = {"type": kind, "robot": robot, "node": 1}
    return {"mask": mask, "parent": parent, "children": list(children) or ["NONE"], **more}


def two_robots() -> Nodes:
    """THEN(AND(clock, bird), cup) for robot 0, and the same for robot 1."""
    nodes: Nodes = {}
    for robot in (0, 1):
        names = {key: f"{key}_{robot}" for key in ("ROOT", "THEN", "AND", "CLOCK", "BIRD", "CUP")}
        root, order, both, clock, bird, cup = names.values()
        nodes |= {
            root: entry(4, "NONE", order, robot=robot),
            order: entry(0, root, both, cup, robot=robot),
            both: entry(2, order, clock, bird, robot=robot),
            clock: entry(5, both, robot=robot, object="clock", peers=[f"CLOCK_{1 - robot}"]),
            bird: entry(3, both, robot=robot, object="bird", off_x=0.5),
            cup: entry(6, order, robot=robot, object="cup", place="shelf"),
        }
    return nodes


def write(nodes: Nodes) -> str:
    return yaml.safe_dump({"NodeList": list(nodes), "Nodes": nodes}, sort_keys=False)


def messages(text: str) -> list[str]:
    with pytest.raises(InvalidFileError) as caught:
        check_task_text(text, BEHAVIORS)
    return [each.message for each in caught.value.problems]


def test_the_first_robots_tree_is_read_and_its_root_left_out() -> None:
    checked = check_task_text(write(two_robots()), BEHAVIORS, default_name="table")
    tree = TaskTree(checked.definition)
    assert checked.definition.name == "table"
    assert [tree.name_of(i) for i in range(len(tree))] == [
        "THEN_0", "AND_0", "CLOCK_0", "BIRD_0", "CUP_0",
    ]  # fmt: skip
    leaves = [tree.leaf_definition(i) for i in tree.leaves]
    assert [(leaf.object, leaf.place) for leaf in leaves] == [
        ("clock", "clock"), ("bird", "bird"), ("cup", "shelf"),
    ]  # fmt: skip


def change(nodes: Nodes, name: str, **fields: Any) -> Nodes:
    nodes[name] |= fields
    return nodes


@pytest.mark.parametrize(
    ("name", "fields", "message"),
    [
        (
            "BIRD_0",
            {"parent": "CUP"},
            "node 'BIRD_0' has parent 'CUP', which 'Nodes' does not have",
        ),
        ("BIRD_0", {"parent": "THEN_0"}, "'AND_0' has child 'BIRD_0', whose parent is 'THEN_0'"),
        ("BIRD_0", {"peers": ["X"]}, "'peers' of node 'BIRD_0' names \"X\", which is not in"),
        ("BIRD_0", {"mask": 3}, "'mask' of node 'BIRD_0' must be a mapping, but it is 3"),
        ("BIRD_0", {"colour": "red"}, "unknown key 'colour'; node 'BIRD_0' may have"),
        ("BIRD_0", {"object": 5}, "'object' of node 'BIRD_0' must be text, but it is 5"),
        ("BIRD_0", {"children": "X"}, "'children' of node 'BIRD_0' must be a list"),
        (
            "THEN_0",
            {"children": ["AND_0"]},
            "node 'CUP_0' has parent 'THEN_0', which does not name",
        ),
        ("AND_0", {"children": ["CLOCK_0", "BIRD_0", "CLOCK_0"]}, "names 'CLOCK_0' twice"),
        ("AND_1", {"mask": {"type": 9, "robot": 1, "node": 1}}, "node 'AND_1' has type 9"),
    ],
)
def test_one_mistake_is_one_sentence(name: str, fields: dict[str, Any], message: str) -> None:
    (told,) = messages(write(change(two_robots(), name, **fields)))
    assert message in told


def test_a_cycle_is_told_once_with_its_nodes() -> None:
    nodes = two_robots() | {"A": entry(0, "B", "B"), "B": entry(2, "A", "A")}
    assert messages(write(nodes)) == ["nodes are their own ancestors: A -> B -> A"]


def test_an_empty_goal_node_and_a_root_of_two_are_told() -> None:
    nodes = {
        "ROOT": entry(4, "NONE", "OR", "CUP"),
        "OR": entry(1, "ROOT"),
        "CUP": entry(3, "ROOT", object="cup"),
    }
    assert messages(write(nodes)) == [
        "root 'ROOT' must have exactly one child, but it has 2",
        "goal node 'OR' is empty; it needs a child",
    ]


def test_two_roots_of_one_robot_are_told() -> None:
    nodes = {
        "A": entry(3, "NONE", object="a"),
        "B": entry(3, "NONE", object="b"),
    }
    assert messages(write(nodes)) == ["'B' and 'A' are both roots for robot 0; a robot has one"]


def test_the_list_and_the_nodes_must_agree() -> None:
    nodes = {"A": entry(3, "NONE", object="a")}
    text = yaml.safe_dump({"NodeList": ["B", "B", 5], "Nodes": nodes})
    assert messages(text) == [
        "'NodeList' names 'B', which 'Nodes' does not have",
        "'NodeList' names 'B' twice",
        "'NodeList' must hold names, but it has 5",
        "node 'A' is not in 'NodeList'",
    ]
