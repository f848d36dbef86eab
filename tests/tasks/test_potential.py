"""How much an agent is drawn to each leaf: to its object, or else to its place."""

import numpy as np
import pytest

from mend.tasks.definition import BehaviorNode, GoalNode, NodeKind, TaskTreeDefinition
from mend.tasks.node_table import NodeTable
from mend.tasks.potential import CLIMB, MIN_DISTANCE_M, Point, leaf_potentials

HERE: Point = (0.0, 0.0, 3.5)


def potentials(
    *parameters: dict[str, str], seen: dict[str, Point], places: dict[str, Point] | None
) -> list[float]:
    """Those of leaves with these parameters, for an agent that can do them all as well."""
    goal = GoalNode(parent=None, name="all", kind=NodeKind.AND)
    leaves = [
        BehaviorNode(parent=0, name=f"leaf{number}", behavior="do", parameters=dict(each))
        for number, each in enumerate(parameters)
    ]
    definition = TaskTreeDefinition(name="task", scene=None, nodes=[goal, *leaves])
    numbers = np.arange(1, len(leaves) + 1)
    suitable = np.ones(len(leaves))
    nodes = NodeTable.of(definition)
    return leaf_potentials(nodes, numbers, seen, HERE, suitable, places).tolist()


def test_a_leaf_draws_by_how_far_its_object_was_seen_whatever_its_place() -> None:
    near, unseen = {"object": "cup", "place": "far"}, {"object": "plate", "place": "far"}
    found = potentials(near, unseen, seen={"cup": (0.0, 2.0, 3.5)}, places={"far": (9.0, 0.0, 0.0)})
    assert found == [0.5, 0.0]


def test_a_leaf_without_an_object_draws_by_how_far_its_place_is() -> None:
    places = {"near": (4.0, 0.0, 3.5), "at it": HERE}
    found = potentials({"place": "near"}, {"place": "at it"}, seen={}, places=places)
    assert found == [0.25, 1.0 / MIN_DISTANCE_M]


def test_the_room_below_draws_less_than_one_across_the_floor() -> None:
    places = {"below": (0.0, 0.0, 0.0), "across": (60.0, 0.0, 3.5)}
    below, across = potentials({"place": "below"}, {"place": "across"}, seen={}, places=places)
    assert below == pytest.approx(1.0 / (3.5 * CLIMB))
    assert below < across


@pytest.mark.parametrize("places", [None, {}, {"other": HERE}])
def test_what_has_neither_an_object_nor_a_known_place_draws_as_suitable_as_it_is(
    places: dict[str, Point] | None,
) -> None:
    assert potentials({}, {"place": "there"}, seen={}, places=places) == [1.0, 1.0]
