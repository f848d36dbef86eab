"""What the head camera cannot tell apart, or cannot see: said before a run, never guessed in it."""

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from mend.robots.vision.color_model import ColorModel
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.part_boxes import Size, boxes_of
from mend.tasks.scene import Scene, SceneObject
from mend.tasks.scene_problem import SceneProblem

SIZE_RESOLUTION_M = 0.004
"""Sizes that differ by less are the same to the cameras."""
DARKEST = 0.14
"""From a colour without any channel as bright as this too little light comes back for depth."""
LOWEST_M = 0.008
NARROWEST_M = 0.010
"""What is lower, or narrower, does not stand out from the table in a noisy picture."""
RIM_M = 0.005
"""Of a plate under a square knob so much has to be seen beside that."""
_ROUNDING_M = 1e-9
"""Sides that are said in whole millimetres differ by them only nearly, as numbers."""
_SQUARE_M = 0.0025
"""A knob, or a plate, is square if its sides differ by less."""
_OBLONG_M = 0.008
"""Which way round a plate lies that is longer by so much is seen however wide its rim is."""


def find_lookalikes(
    scene: Scene, nodes: Sequence[GoalNode | BehaviorNode], model: ColorModel
) -> list[SceneProblem]:
    """What in a scene cannot be recognized though it has to be; empty where all can.

    Exactly equal objects are no problem: any of them will do. Without leaves among the
    `nodes` every object counts as needed. `model` knows the colours of the scene's objects.
    """
    leaves = [node for node in nodes if isinstance(node, BehaviorNode)]
    needed = {leaf.object for leaf in leaves} if leaves else set(scene.objects)
    problems = [
        SceneProblem(("objects", name), message)
        for name, each in scene.objects.items()
        if name in needed
        for message in _unseen(name, each)
    ]
    for one, other in combinations(scene.objects, 2):
        if {one, other} & needed and _look_alike(scene, one, other, model):
            problems.append(_lookalike(scene, one, other))
    return problems


def _unseen(name: str, each: SceneObject) -> Iterator[str]:
    if max(each.color) < DARKEST:
        yield (
            f"'{name}' is too dark for the depth camera: give its colour a channel of at least "
            f"{DARKEST}"
        )
    if each.size[2] < LOWEST_M:
        yield (
            f"'{name}' is {each.size[2] * 1e3:g} mm high, which the head camera cannot tell from "
            f"the table: make it at least {LOWEST_M * 1e3:g} mm high"
        )
    if min(each.size[:2]) < NARROWEST_M:
        yield (
            f"'{name}' is {min(each.size[:2]) * 1e3:g} mm wide, which the head camera cannot see "
            f"well enough: make it at least {NARROWEST_M * 1e3:g} mm wide"
        )
    if each.knob is not None and _hides_its_turn(each.size, each.knob):
        yield (
            f"the cameras cannot tell which way round '{name}' lies: its knob is square and "
            f"covers all but a narrow rim of a plate that is not. Make the plate square too, or "
            f"{_OBLONG_M * 1e3:g} mm longer than wide, or its rim at least {RIM_M * 1e3:g} mm wide"
        )


def _hides_its_turn(plate: Size, knob: Size) -> bool:
    """Whether a quarter turn of a plate and its knob would hardly show."""
    oblong_m = abs(plate[0] - plate[1])
    rim_m = (plate[0] - knob[0] if plate[0] > plate[1] else plate[1] - knob[1]) / 2
    is_square = abs(knob[0] - knob[1]) < _SQUARE_M
    return is_square and _SQUARE_M <= oblong_m < _OBLONG_M and rim_m < RIM_M


def _look_alike(scene: Scene, one: str, other: str, model: ColorModel) -> bool:
    first, second = scene.objects[one], scene.objects[other]
    if (first.size, first.knob, first.color) == (second.size, second.knob, second.color):
        return False
    if (first.knob is None) != (second.knob is None):
        return False
    apart_m = np.abs(_measures(first) - _measures(second)).max()
    return bool(apart_m < SIZE_RESOLUTION_M - _ROUNDING_M) and model.look_alike(one, other)


def _measures(each: SceneObject) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """All that is seen of a box or plate from above, whichever way it is turned."""
    boxes = boxes_of(each.size, each.knob)
    return np.array([side for _, box in boxes for side in (*sorted(box[:2]), box[2])])


def _lookalike(scene: Scene, one: str, other: str) -> SceneProblem:
    first, second = (_in_mm(scene.objects[name]) for name in (one, other))
    return SceneProblem(
        ("objects", other),
        f"the cameras cannot tell '{other}' ({second}) from '{one}' ({first}): make them exactly "
        f"equal, so that either will do, or let a side differ by at least "
        f"{SIZE_RESOLUTION_M * 1e3:g} mm or the colour clearly",
    )


def _in_mm(each: SceneObject) -> str:
    return " x ".join(f"{side * 1e3:g}" for side in each.size) + " mm"
