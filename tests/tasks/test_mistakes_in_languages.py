"""What is wrong in a file is told in every language of the console."""

from collections.abc import Callable
from typing import Any

import pytest
from languages_of_console import untold
from trees import BEHAVIORS

from mend.documents.problem import InvalidFileError
from mend.tasks.scenario_file import check_scenario_text
from mend.tasks.scene_file import check_scene_text
from mend.tasks.task_file import check_task_text

LEAF = "{behavior: pick_and_place, object: green_leg, place: green_leg}"
HEAD = "name: t\nscene: eket\n"
CUP = "name: s\nplaces: {}\nobjects:\n  cup: "
GOOD = "name: s\ntree: eket\n"

TASKS = [
    "",
    "7",
    "[a, b]",
    "name: [",
    "name: t\n\ttree: x",
    "a: &x 1\nb: *y",
    "a: 1\na: 2",
    "a: !!set {}",
    "--- 1\n--- 2",
    "{1: 2}",
    "a: b: c",
    "'a",
    "tree: {}",
    f"name: 7th\nscene: 5\ntree: {LEAF}",
    f"name: t\nauthor: me\ntree: {LEAF}",
    f"{HEAD}tree: green_leg",
    f"{HEAD}tree:\n  then: []",
    f"{HEAD}tree:\n  or: 5",
    f"{HEAD}tree:\n  then: [{LEAF}]\n  or: [{LEAF}]",
    f"{HEAD}tree:\n  then: [{LEAF}]\n  colour: red",
    f"{HEAD}tree: {{behaviour: pick_and_place}}",
    f"{HEAD}tree: {{behavior: jump}}",
    f"{HEAD}tree: {{behavior: [a]}}",
    f"{HEAD}tree: {{behavior: pick_and_place, object: 5, plce: x}}",
    f"{HEAD}tree: {{behavior: pick_and_place, object: red_leg, place: nowhere}}",
    f"{HEAD}tree:\n  and: [{LEAF}, {LEAF}]",
    f"name: t\nscene: moon\ntree: {LEAF}",
]
SCENES = [
    "",
    "name: 5",
    "name: s\nobjects: {}\nplaces: {7th: {pose: {x: 0.5, y: 0.1}}}",
    "name: s\nplace: {}\nobjects: {}\nplaces: {}",
    CUP + "{color: red, size: [0.03, 0.05, 0.05], pose: {x: left, y: 0.1}}",
    CUP + "{color: [1, 2, 0], size: [0.03, 0.05, 0.05], pose: {x: 0.5, y: 0.1, yaw: 90}}",
    CUP + "{color: [1, 0.5], size: [0.03, 0.05, 0.05], pose: {x: 0.5, y: 0.1, roll: 1}}",
    CUP + "{color: [1, 0, 0], size: [0, 0.05, 0.05], pose: {x: 0.5, y: 0.1}}",
]
SCENARIOS = [
    GOOD + "answers: [perhaps]",
    GOOD + "helpers: 5",
    GOOD + "interventions:\n  - do: {act: steal, object: pink_bar}",
    GOOD + "interventions:\n  - at_s: 1\n    do: {act: move, object: pink_bar}",
    GOOD + "interventions:\n  - at_s: 1\n    do: {act: steal}",
    GOOD + "interventions:\n  - at_s: -1\n    do: {act: cover}",
    GOOD + "interventions:\n  - when: {object: pink_bar, step: 0}\n    do: {act: cover}",
]


def check_task(text: str) -> Any:
    return check_task_text(text, BEHAVIORS)


CHECKED: list[tuple[Callable[[str], Any], str]] = [
    *((check_task, text) for text in TASKS),
    *((check_scene_text, text) for text in SCENES),
    *((check_scenario_text, text) for text in SCENARIOS),
]


@pytest.mark.parametrize(("check", "text"), CHECKED)
def test_every_mistake_is_told_in_every_language(check: Callable[[str], Any], text: str) -> None:
    with pytest.raises(InvalidFileError) as caught:
        check(text)
    told = [each.message for each in caught.value.problems]
    assert untold(told, ("clauses", "refusals")) == []
