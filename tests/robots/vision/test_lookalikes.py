"""What the cameras cannot tell apart is said before the run; equal and different things are not."""

import pytest

from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.lookalikes import find_lookalikes
from mend.sim.color_lessons import Studio, teach_colors
from mend.sim.raster import Light
from mend.tasks.definition import BehaviorNode
from mend.tasks.scene import Place, Pose, Scene, SceneObject

RED = (0.8, 0.1, 0.1)
SIZE = (0.03, 0.05, 0.04)


def part(size=SIZE, color=RED, knob=None) -> SceneObject:
    return SceneObject(color=color, size=size, knob=knob, pose=Pose(x=0.5, y=0.0))


def check(objects: dict[str, SceneObject], needed: tuple[str, ...] = ()) -> list[str]:
    scene = Scene(name="pair", objects=objects, places={"there": Place(pose=Pose(x=0.5, y=0.2))})
    leaves = [
        BehaviorNode(
            parent=None,
            name=name,
            behavior="pick_and_place",
            parameters={"object": name, "place": "there"},
        )
        for name in needed
    ]
    model: ColorModel = teach_colors(scene, Studio((0.8, 0.78, 0.74), Light()), 0.0)
    return [each.message for each in find_lookalikes(scene, leaves, model)]


@pytest.mark.parametrize(
    "other",
    [
        part(size=(0.031, 0.05, 0.04)),
        part(size=(0.05, 0.03, 0.04)),
        part(color=(0.8, 0.1, 0.105)),
    ],
    ids=["a millimetre wider", "turned", "hardly redder"],
)
def test_what_is_almost_equal_is_named_with_what_would_be_right(other: SceneObject) -> None:
    (message,) = check({"one": part(), "other": other})
    assert "'one'" in message
    assert "'other'" in message
    assert "exactly equal" in message


@pytest.mark.parametrize(
    "other",
    [
        part(),
        part(size=(0.035, 0.05, 0.04)),
        part(size=(0.034, 0.05, 0.04)),
        part(size=(0.03, 0.05, 0.045)),
        part(color=(0.8, 0.4, 0.1)),
        part(color=(0.4, 0.05, 0.05)),
        part(knob=(0.02, 0.02, 0.02)),
    ],
    ids=["equal", "wider", "4 mm wider", "higher", "another hue", "darker", "with a knob"],
)
def test_equal_and_different_parts_are_no_problem(other: SceneObject) -> None:
    assert check({"one": part(), "other": other}) == []


def test_lookalikes_that_no_leaf_needs_are_no_problem() -> None:
    objects = {"one": part(), "other": part(size=(0.031, 0.05, 0.04)), "third": part((0.1,) * 3)}
    assert check(objects, needed=("third",)) == []
    assert len(check(objects, needed=("one",))) == 1


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (part(color=(0.05, 0.02, 0.0)), "too dark for the depth camera"),
        (part(size=(0.03, 0.05, 0.005)), "5 mm high"),
        (part(size=(0.006, 0.05, 0.04)), "6 mm wide"),
    ],
)
def test_what_the_head_camera_cannot_see_is_said(bad: SceneObject, words: str) -> None:
    (message,) = check({"bad": bad})
    assert words in message


@pytest.mark.parametrize(
    "size",
    [(0.065, 0.060, 0.02), (0.060, 0.066, 0.02), (0.063, 0.060, 0.02)],
)
def test_a_square_knob_that_hides_which_way_round_its_plate_lies_is_refused(size) -> None:
    (message,) = check({"one": part(size=size, knob=(0.06, 0.06, 0.03))})
    assert "which way round 'one' lies" in message


@pytest.mark.parametrize(
    ("size", "knob"),
    [
        ((0.065, 0.065, 0.02), (0.06, 0.06, 0.03)),
        ((0.068, 0.060, 0.02), (0.06, 0.06, 0.03)),
        ((0.065, 0.060, 0.02), (0.05, 0.05, 0.03)),
        ((0.065, 0.060, 0.02), (0.06, 0.05, 0.03)),
    ],
    ids=["a square plate", "a long plate", "a wide rim", "a long knob"],
)
def test_plates_that_show_how_they_lie_are_taken(size, knob) -> None:
    assert check({"one": part(size=size, knob=knob)}) == []
