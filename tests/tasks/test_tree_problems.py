"""Mistakes of a task tree that no robot could make good, and the sentence for each."""

import json
from typing import Any

import numpy as np
import pytest
from random_task import random_task
from trees import BEHAVIORS

from mend.documents.problem import InvalidFileError
from mend.sim.random_nesting import random_ordered_nesting
from mend.tasks.scene import Place, Pose, Scene, SceneObject
from mend.tasks.task_file import check_task_text

SLAB = (0.10, 0.10, 0.05)


def leaf(name: str, place: str | None = None) -> dict[str, Any]:
    return {"behavior": "pick_and_place", "object": name, "place": place or name}


def scene(starts: dict[str, tuple[float, float]], places: dict[str, tuple[float, float]]) -> Scene:
    """Slabs, each at a y and a height above the table."""

    def pose(y: float, above: float) -> Pose:
        return Pose(x=0.5, y=y, z=0.7 + above if above else None)

    return Scene(
        name="s",
        objects={
            name: SceneObject(color=(1.0, 0.0, 0.0), size=SLAB, pose=pose(*at))
            for name, at in starts.items()
        },
        places={name: Place(pose=pose(*at)) for name, at in places.items()},
    )


APART = scene(
    {"a": (-0.6, 0), "b": (-0.4, 0), "c": (-0.2, 0)}, {"a": (0, 0), "b": (0.2, 0), "c": (0.4, 0)}
)
TOWER = scene(
    {"a": (-0.6, 0), "b": (-0.4, 0), "c": (-0.2, 0)},
    {"a": (0, 0), "b": (0, 0.05), "c": (0, 0.10), "d": (0.3, 0)},
)
FOUNDATION = scene(
    {"a": (-0.6, 0), "b": (-0.4, 0), "c": (-0.2, 0)},
    {"a": (0, 0), "b": (-0.6, 0.05), "c": (0.4, 0), "under": (-0.6, 0)},
)
PILE = scene(
    {"a": (-0.6, 0), "b": (-0.6, 0.05), "c": (-0.2, 0)}, {"a": (0, 0), "b": (0.2, 0), "c": (0.4, 0)}
)
EXCHANGE = scene(
    {"a": (-0.6, 0), "b": (-0.4, 0), "c": (0.4, 0)}, {"a": (-0.4, 0), "b": (0, 0), "c": (0.2, 0)}
)


def told(tree: dict[str, Any], of: Scene = APART) -> list[str]:
    """The sentences about a tree, without where they are."""
    text = json.dumps({"name": "t", "tree": tree})
    try:
        check_task_text(text, BEHAVIORS, scene=of)
    except InvalidFileError as error:
        return [each.message for each in error.problems]
    return []


A, B, C = leaf("a"), leaf("b"), leaf("c")
OR_ELSE = "and an OR may have something else done than placing that"
STARTS = "'b' is to stand on 'a' where that starts, but 'a' is to be brought elsewhere"
LATER = "is not sure to be placed before it"


@pytest.mark.parametrize(
    ("tree", "of", "message"),
    [
        ({"and": [A, leaf("b", "a")]}, APART, "the place 'a' is filled twice, by 'a' and by 'b'"),
        ({"then": [A, leaf("b", "a")]}, APART, "the place 'a' is filled twice"),
        ({"and": [A, leaf("a", "b")]}, APART, "the object 'a' is placed twice"),
        ({"then": [A, {"or": [B, leaf("a", "c")]}]}, APART, "the object 'a' is placed twice"),
        ({"and": [{"or": [A, B]}, {"or": [A, C]}]}, APART, "the object 'a' is placed twice"),
        ({"then": [B, A]}, TOWER, f"'b' is to stand on 'a', which {LATER}"),
        ({"and": [A, B]}, TOWER, f"'b' is to stand on 'a', which {LATER}"),
        ({"then": [A, {"and": [B, C]}]}, TOWER, f"'c' is to stand on 'b', which {LATER}"),
        ({"then": [A, B]}, PILE, "'b' starts on 'a' and is not sure to be taken off before it"),
        ({"and": [A, B]}, PILE, "'b' starts on 'a' and is not sure to be taken off before it"),
        ({"then": [A, C]}, PILE, "'b' starts on 'a', and nothing takes it off"),
        ({"or": [A, B]}, PILE, "'b' starts on 'a' and is not sure to be taken off before it"),
        (
            {"then": [{"or": [B, C]}, A]},
            PILE,
            "'b' starts on 'a' and is not sure to be taken off before it",
        ),
        ({"or": [A, B]}, TOWER, "'b' is to stand on 'a', which an OR has placed only instead"),
        ({"then": [A, B]}, EXCHANGE, "'a' is to go where 'b' starts"),
        ({"and": [A, B]}, EXCHANGE, "'a' is to go where 'b' starts"),
        ({"then": [{"or": [B, C]}, A]}, EXCHANGE, "'a' is to go where 'b' starts"),
        ({"or": [A, B]}, EXCHANGE, "'a' is to go where 'b' starts"),
        ({"then": [{"or": [A, leaf("c", "d")]}, B]}, TOWER, f"'b' is to stand on 'a', {OR_ELSE}"),
        (
            {"then": [{"or": [{"and": [A]}, {"then": [leaf("c", "d")]}]}, B]},
            TOWER,
            f"'b' is to stand on 'a', {OR_ELSE}",
        ),
        ({"then": [A, B]}, FOUNDATION, STARTS),
        ({"then": [B, A]}, FOUNDATION, STARTS),
        ({"then": [{"or": [A, C]}, B]}, FOUNDATION, STARTS),
    ],
)
def test_a_tree_that_cannot_be_done_is_told_so(tree, of, message) -> None:
    sentences = told(tree, of)
    assert any(message in sentence for sentence in sentences), sentences


@pytest.mark.parametrize(
    ("tree", "of"),
    [
        ({"and": [A, B, C]}, APART),
        ({"or": [A, leaf("b", "a")]}, APART),
        ({"or": [A, leaf("a", "b")]}, APART),
        ({"then": [{"or": [A, {"then": [leaf("b", "a"), C]}]}]}, APART),
        ({"then": [A, B, C]}, TOWER),
        ({"then": [{"and": [A]}, {"then": [B, C]}]}, TOWER),
        ({"or": [{"then": [A, B]}, leaf("c", "d")]}, TOWER),
        ({"then": [{"or": [A, leaf("c", "a")]}, B]}, TOWER),
        ({"then": [{"or": [A, {"and": [leaf("c", "a")]}]}, B]}, TOWER),
        ({"or": [A, B]}, FOUNDATION),
        ({"then": [A, leaf("c", "under"), B]}, FOUNDATION),
        ({"then": [B, A]}, PILE),
        ({"then": [B, {"and": [A, C]}]}, PILE),
        ({"then": [{"or": [B, leaf("b", "c")]}, A]}, PILE),
        ({"or": [{"then": [B, A]}, leaf("b", "c")]}, PILE),
        ({"and": [B, C]}, PILE),
        ({"then": [B, A]}, EXCHANGE),
        ({"then": [{"or": [B, leaf("b", "c")]}, A]}, EXCHANGE),
        ({"then": [{"and": [B, C]}, A]}, EXCHANGE),
    ],
)
def test_a_tree_that_can_be_done_is_not_refused(tree, of) -> None:
    assert told(tree, of) == []


def test_a_mistake_is_told_with_the_line_of_the_place() -> None:
    text = """\
name: t
tree:
  and:
    - {behavior: pick_and_place, object: a, place: spot}
    - behavior: pick_and_place
      object: b
      place: spot
"""
    with pytest.raises(InvalidFileError, match=r"t:7: /1: the place 'spot' is filled twice"):
        check_task_text(text, BEHAVIORS, source="t")


def test_random_trees_of_different_parts_and_places_are_taken() -> None:
    rng = np.random.default_rng(1)
    for leaves in (1, 2, 30, 300):
        check_task_text(json.dumps(random_task(rng, leaves)), BEHAVIORS)


def test_a_random_nesting_that_keeps_the_order_of_a_tower_is_taken() -> None:
    order = {("a", "b"), ("b", "c")}
    for seed in range(30):
        rng = np.random.default_rng(seed)
        tree = random_ordered_nesting(rng, {"a": A, "b": B, "c": C}, order)
        assert told(tree, TOWER) == []


def test_an_order_that_contradicts_itself_is_refused() -> None:
    rng = np.random.default_rng(0)
    with pytest.raises(ValueError, match="contradicts itself"):
        random_ordered_nesting(rng, {"a": A, "b": B}, {("a", "b"), ("b", "a")})
