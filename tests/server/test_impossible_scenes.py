"""Scenes and trees that cannot be done are refused with the right sentence, possible ones never."""

import copy
import json
from typing import Any

import pytest

from mend.documents.problem import InvalidFileError
from mend.errors import WrongInputError
from mend.server.behaviors import behavior_parameters
from mend.server.scene_checks import load_world_checks
from mend.tasks.library import SCENES
from mend.tasks.scene import Scene
from mend.tasks.scene_file import built_in_scene, check_scene_text
from mend.tasks.task_file import check_task_text

WORLDS = ("tabletop", "workcell")

POSSIBLE: dict[str, Any] = {
    "name": "bench",
    "objects": {
        "cup": {
            "color": [0.9, 0.1, 0.1],
            "size": [0.05, 0.05, 0.06],
            "pose": {"x": 0.45, "y": -0.5},
        },
        "box": {
            "color": [0.1, 0.2, 0.9],
            "size": [0.04, 0.07, 0.05],
            "pose": {"x": 0.58, "y": -0.35},
        },
        "lid": {
            "color": [0.1, 0.7, 0.2],
            "size": [0.09, 0.10, 0.012],
            "knob": [0.026, 0.03, 0.03],
            "pose": {"x": 0.45, "y": -0.3},
        },
    },
    "places": {
        "cup": {"pose": {"x": 0.45, "y": -0.05}},
        "box": {"pose": {"x": 0.58, "y": 0.05}},
        "lid": {"pose": {"x": 0.45, "y": 0.1}},
    },
}
ON_BOX = {"pose": {"x": 0.58, "y": 0.05, "z": 0.75}}


def leaf(name: str, place: str | None = None) -> dict[str, Any]:
    return {"behavior": "pick_and_place", "object": name, "place": place or name}


CUP, BOX, LID = leaf("cup"), leaf("box"), leaf("lid")
ALL = {"and": [CUP, BOX, LID]}
# A tree of the cup alone does where only it is impossible: a plan that fails is sought for long.


def changed(**changes: Any) -> dict[str, Any]:
    """The possible scene with other values: `cup__size=[...]`, `at_cup__pose__x=1.0`."""
    document = copy.deepcopy(POSSIBLE)
    for key, value in changes.items():
        first, *steps = key.split("__")
        target = document["places" if first.startswith("at_") else "objects"]
        way = [first.removeprefix("at_"), *steps]
        for step in way[:-1]:
            target = target[step]
        target[way[-1]] = value
    return document


def told(document: dict[str, Any], tree: dict[str, Any], world: str) -> list[str]:
    """All sentences about a scene and a tree in it."""
    try:
        scene = check_scene_text(json.dumps(document))
        task = check_task_text(
            json.dumps({"name": "t", "tree": tree}), behavior_parameters(), scene=scene
        )
    except InvalidFileError as error:
        return [each.message for each in error.problems]
    problems = load_world_checks().only(world).try_tree(scene, task.definition)[world]
    return [each.message for each in problems]


def equal(name: str, x: float, y: float, **changes: Any) -> dict[str, Any]:
    return {**POSSIBLE["objects"][name], "pose": {"x": x, "y": y}, **changes}


IMPOSSIBLE = [
    # What the gripper cannot take.
    ("too wide", changed(cup__size=[0.09, 0.09, 0.06]), ALL, "takes 12 to 78 mm"),
    ("too narrow", changed(cup__size=[0.006, 0.008, 0.06]), ALL, "takes 12 to 78 mm"),
    ("too low", changed(cup__size=[0.05, 0.05, 0.008]), ALL, "it has to be at least"),
    ("hardly too low", changed(cup__size=[0.05, 0.05, 0.0195]), ALL, "it has to be at least 20 mm"),
    ("too heavy", changed(cup__mass_kg=3.0), ALL, "weighs 3.00 kg"),
    ("knob too wide", changed(lid__knob=[0.085, 0.09, 0.03]), ALL, "the knob of lid"),
    ("knob too narrow", changed(lid__knob=[0.005, 0.007, 0.03]), ALL, "the knob of lid"),
    # What the arm cannot reach.
    ("starts too far", changed(cup__pose__x=0.95), CUP, "does not reach (0.950, -0.500"),
    ("starts too far aside", changed(cup__pose={"x": 0.75, "y": -0.70}), CUP, None),
    ("goes too far", changed(at_cup__pose__x=1.0), CUP, None),
    ("goes too high", changed(at_cup__pose__z=1.5), ALL, "is in the air"),
    # What would not stand.
    ("starts beyond the table", changed(cup__pose__x=1.2), ALL, "is beyond the table"),
    ("goes beyond the table", changed(at_cup__pose__y=0.9), ALL, "is beyond the table"),
    ("over the edge", changed(cup__pose__x=0.36), ALL, "reaches over the edge"),
    ("goes over the edge", changed(at_lid__pose__x=0.36), ALL, "reaches over the edge"),
    ("behind the robot", changed(cup__pose__x=-0.4), ALL, "is beyond the table"),
    ("starts in the air", changed(cup__pose__z=0.9), ALL, "is in the air"),
    ("goes into the air", changed(at_cup__pose__z=0.8), ALL, "is in the air"),
    ("below the table", changed(at_cup__pose__z=0.4), ALL, "is below the table"),
    (
        "not on the box's top",
        changed(at_cup__pose={"x": 0.58, "y": 0.05, "z": 0.78}),
        {"then": [BOX, CUP, LID]},
        "the nearest top there is that of box, at z 0.750",
    ),
    (
        "tips off the box",
        changed(at_cup__pose={"x": 0.58, "y": 0.088, "z": 0.75}),
        {"then": [BOX, CUP, LID]},
        "would tip off box",
    ),
    ("as high as a bottle rack", changed(cup__size=(0.06, 0.06, 0.28)), CUP, "is 280 mm high"),
    ("a needle on end", changed(cup__size=(0.014, 0.014, 0.11)), ALL, "would tip over as soon as"),
    # No room.
    ("one spot", changed(cup__pose={"x": 0.58, "y": -0.35}), ALL, "start in one spot"),
    ("inside each other", changed(cup__pose={"x": 0.56, "y": -0.36}), ALL, "start in one spot"),
    ("places in one spot", changed(at_cup__pose={"x": 0.58, "y": 0.05}), ALL, "inside each other"),
    (
        "starts too close for the fingers",
        changed(
            cup__pose={"x": 0.5, "y": -0.35},
            box={**equal("box", 0.555, -0.35), "size": [0.05, 0.06, 0.06]},
            post={**equal("box", 0.5, -0.295), "size": [0.06, 0.05, 0.06]},
            lid__pose={"x": 0.45, "y": -0.6},
        ),
        ALL,
        "for the fingers",
    ),
    (
        "a place where something stands",
        changed(at_cup__pose={"x": 0.58, "y": -0.35}),
        {"and": [CUP, LID]},
        "which nothing takes away",
    ),
    # What the tree does not allow.
    ("two parts, one place", POSSIBLE, {"and": [CUP, leaf("box", "cup")]}, "is filled twice"),
    ("one part, two places", POSSIBLE, {"then": [CUP, leaf("cup", "box")]}, "is placed twice"),
    ("stacked in any order", changed(at_cup=ON_BOX), {"and": [BOX, CUP]}, "put 'box' before 'cup'"),
    ("stacked too early", changed(at_cup=ON_BOX), {"then": [CUP, BOX]}, "put 'box' before 'cup'"),
    (
        "taken from under another one",
        changed(cup__pose={"x": 0.58, "y": -0.35, "z": 0.75}),
        {"then": [BOX, CUP]},
        "'cup' starts on 'box'",
    ),
    (
        "put where another one still is",
        changed(at_cup__pose={"x": 0.58, "y": -0.35}),
        {"then": [CUP, BOX]},
        "is to go where 'box' starts",
    ),
    ("no such object", POSSIBLE, leaf("mug", "cup"), "has no object 'mug'"),
    ("no such place", POSSIBLE, leaf("cup", "shelf"), "has no place 'shelf'"),
    # What is no scene.
    ("no size", changed(cup__size=[0.05, 0.0, 0.06]), ALL, "must be greater than 0.000001"),
    (
        "hardly a size",
        changed(cup__size=[0.05, 5e-324, 0.06]),
        ALL,
        "must be greater than 0.000001",
    ),
    ("no colour", changed(cup__color=[2.0, 0.1, 0.1]), ALL, "less than or equal to 1"),
]
UNSEEN = [
    (
        "lookalikes",
        changed(mug=equal("cup", 0.58, -0.52, size=[0.051, 0.05, 0.06])),
        ALL,
        "cannot tell",
    ),
    ("touching", changed(mug=equal("cup", 0.502, -0.5)), {"and": [BOX, LID]}, "cannot tell mug"),
    (
        "touching at their places",
        {
            **changed(mug=equal("cup", 0.58, -0.52)),
            "places": {**POSSIBLE["places"], "mug": {"pose": {"x": 0.503, "y": -0.05}}},
        },
        {"and": [CUP, leaf("mug")]},
        "cannot tell mug",
    ),
    (
        "hidden",
        changed(
            cup__pose={"x": 0.52, "y": -0.45},
            cup__size=[0.03, 0.03, 0.03],
            screen=equal("cup", 0.41, -0.40, size=[0.04, 0.16, 0.28]),
        ),
        CUP,
        "screen hides cup from the head camera",
    ),
    ("too dark", changed(cup__color=[0.02, 0.02, 0.02]), ALL, "too dark"),
]
ANY_REACH = {"starts too far", "starts too far aside", "goes too far"}
"""The tabletop's arm reaches every place of a scene; what it does not reach is not the same."""


@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize(("document", "tree", "sentence"), [
    pytest.param(*case[1:], id=case[0]) for case in IMPOSSIBLE if case[0] not in ANY_REACH
])  # fmt: skip
def test_what_is_impossible_is_refused_with_the_right_sentence(
    document: dict[str, Any], tree: dict[str, Any], sentence: str, world: str
) -> None:
    sentences = told(document, tree, world)
    assert any(sentence in each for each in sentences), sentences


@pytest.mark.slow
@pytest.mark.parametrize(("document", "tree"), [
    pytest.param(*case[1:3], id=case[0]) for case in IMPOSSIBLE if case[0] in ANY_REACH
])  # fmt: skip
def test_what_the_workcells_arm_does_not_reach_is_told_so(
    document: dict[str, Any], tree: dict[str, Any]
) -> None:
    assert any("the arm does not reach" in each for each in told(document, tree, "workcell"))


@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize(("document", "tree", "sentence"), [
    pytest.param(*case[1:], id=case[0]) for case in UNSEEN
])  # fmt: skip
def test_what_the_cameras_cannot_tell_is_told(
    document: dict[str, Any], tree: dict[str, Any], sentence: str, world: str
) -> None:
    assert any(sentence in each for each in told(document, tree, world))


def test_there_are_enough_of_them() -> None:
    assert len(IMPOSSIBLE) + len(UNSEEN) >= 30


@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize(
    ("document", "tree"),
    [
        (POSSIBLE, ALL),
        (POSSIBLE, {"or": [CUP, leaf("box", "cup")]}),
        (changed(at_cup=ON_BOX), {"then": [BOX, CUP, LID]}),
        (changed(at_cup=ON_BOX), {"then": [{"and": [BOX, LID]}, CUP]}),
        (changed(cup__pose={"x": 0.58, "y": -0.35, "z": 0.75}), {"then": [CUP, BOX]}),
        (changed(at_cup__pose={"x": 0.58, "y": -0.35}), {"then": [BOX, CUP]}),
        (changed(mug=equal("cup", 0.58, -0.52)), ALL),
        (changed(cup__size=[0.078, 0.078, 0.12], cup__mass_kg=0.5), ALL),
        (changed(cup__size=[0.012, 0.02, 0.02]), ALL),
        (changed(mug=equal("cup", 0.506, -0.5)), {"and": [BOX, LID]}),
        (changed(at_cup__pose={"x": 0.58, "y": 0.05}), {"or": [BOX, CUP]}),
        (changed(cup__pose__yaw=1.2, at_cup__pose__yaw=-2.5), ALL),
    ],
)
def test_what_is_possible_is_never_refused(
    document: dict[str, Any], tree: dict[str, Any], world: str
) -> None:
    assert told(document, tree, world) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES.names())
def test_every_scene_of_the_library_is_possible_by_itself(name: str) -> None:
    scene: Scene = built_in_scene(name)
    assert load_world_checks().try_scene(scene) == {world: [] for world in WORLDS}


def test_a_world_that_there_is_not_is_told() -> None:
    with pytest.raises(
        WrongInputError, match="there is no world 'mars'; there are building, tabletop, workcell"
    ):
        load_world_checks().only("mars")
