"""Scenario files are read strictly, and every mistake is told with its line."""

import json
from pathlib import Path

import pytest

from mend.documents.problem import InvalidFileError
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.intervention import Act
from mend.tasks.library import SCENARIOS, NotInLibraryError
from mend.tasks.scenario import Scenario, Trigger
from mend.tasks.scenario_file import (
    built_in_scenario,
    check_scenario_text,
    find_misfits,
    read_scenario_file,
    read_scenario_text,
)
from mend.tasks.scene import Place, Pose, Scene, SceneObject

WHEN = "when: {object: pink_bar, step: 5, fraction: 0.5}"
GOOD = """\
name: short
tree: eket
interventions:
  - when: {object: pink_bar, step: 5, fraction: 0.5}
    do: {act: steal, object: pink_bar}
answers: [no, yes, silence]
person: {acts: false}
"""

LEAF = BehaviorNode(
    parent=None,
    name="pink_bar",
    behavior="pick_and_place",
    parameters={"object": "pink_bar", "place": "left"},
)
TREE = TaskTreeDefinition(name="eket", nodes=[LEAF])


def problems_of(text: str) -> list[str]:
    with pytest.raises(InvalidFileError) as caught:
        check_scenario_text(text, source="mine.yaml")
    return [each.describe("mine.yaml") for each in caught.value.problems]


@pytest.mark.parametrize("name", SCENARIOS.names())
def test_every_scenario_that_comes_with_mend_is_sound(name: str) -> None:
    scenario = built_in_scenario(name)
    assert scenario.name == name
    assert scenario.description


def test_plain_yes_and_no_are_answers_and_true_and_false_are_not() -> None:
    scenario = check_scenario_text(GOOD, source="mine.yaml")
    assert scenario.answers == ["no", "yes", "silence"]
    assert scenario.person.acts is False


def test_a_scenario_may_be_written_in_json() -> None:
    scenario = check_scenario_text(GOOD, source="mine.yaml")
    as_json = json.dumps(scenario.model_dump(mode="json", exclude_defaults=True))
    assert check_scenario_text(as_json, source="mine.json") == scenario


def test_a_scenario_is_read_from_a_file_of_anybodys(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(GOOD)
    assert read_scenario_file(path).scenario == check_scenario_text(GOOD, source="mine.yaml")


def test_an_unknown_scenario_is_told_with_those_that_there_are() -> None:
    with pytest.raises(NotInLibraryError, match="eket_paper"):
        built_in_scenario("eket_papr")


def test_a_name_never_leads_to_another_file(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(GOOD)
    with pytest.raises(NotInLibraryError, match="there is no scenario"):
        built_in_scenario(str(path))


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(InvalidFileError, match="cannot be read"):
        read_scenario_file(tmp_path / "mine.yaml")


def test_a_file_that_is_no_text_is_told(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InvalidFileError, match=r"mine\.yaml"):
        read_scenario_file(path)


def test_every_mistake_is_told_with_its_line() -> None:
    text = GOOD.replace("step: 5", "step: 0").replace("silence", "perhaps") + "helpers: [ana]\n"
    assert problems_of(text) == [
        "mine.yaml:4: 'interventions.0.when.step' must be greater than or equal to 1, but it is 0",
        "mine.yaml:6: 'answers.2' must be 'yes', 'no' or 'silence', but it is \"perhaps\"",
        "mine.yaml:8: unknown key 'helpers'; known are 'answer_delay_s', 'answers', "
        "'description', 'interventions', 'name', 'person', 'scene', 'tree'",
    ]


@pytest.mark.parametrize(
    ("moment", "given"), [("at_s: null", "neither"), (f"{WHEN}\n    at_s: 3.0", "both")]
)
def test_an_intervention_happens_at_one_moment(moment: str, given: str) -> None:
    text = GOOD.replace(WHEN, moment)
    said = f"an intervention needs 'when' or 'at_s' (got {given})"
    assert problems_of(text) == [f"mine.yaml:4: 'interventions.0': {said}"]


def test_an_act_without_what_it_needs_is_told() -> None:
    text = GOOD.replace("{act: steal, object: pink_bar}", "{act: move, object: pink_bar}")
    assert problems_of(text) == ["mine.yaml:5: 'interventions.0.do': act 'move' needs a pose 'to'"]


def test_an_act_of_placing_says_where() -> None:
    put = GOOD.replace("{act: steal, object: pink_bar}", "{act: place, object: pink_bar}")
    (misfit,) = find_misfits(
        check_scenario_text(put, source="mine.yaml"), TREE, None, {"pick_and_place": 8}
    )
    assert misfit.message == "interventions[0].do: act 'place' needs a 'place'"


@pytest.mark.parametrize("setting", [{}, {"building": "office"}])
def test_an_act_of_buildings_is_told_where_the_scene_is_none(setting: dict[str, str]) -> None:
    charge = GOOD.replace("{act: steal, object: pink_bar}", "{act: charge}")
    cup = SceneObject(color=(1.0, 0.0, 0.0), size=(0.1, 0.1, 0.1), pose=Pose(x=0.5, y=0.0))
    scene = Scene(name="tea", objects={"pink_bar": cup}, places={}, setting=setting)
    scenario = check_scenario_text(charge, source="mine.yaml")
    told = [each.message for each in find_misfits(scenario, TREE, scene, {"pick_and_place": 8})]
    sentence = "interventions[0].do: 'charge' is for buildings, and the scene 'tea' is none"
    assert (sentence in told) is (setting == {})


@pytest.mark.parametrize(
    ("z", "why"),
    [
        (None, None),
        (0.7, None),
        (0.8, None),
        (
            3.0,
            "where nothing could hold it: the table is 0.7 m high, and all other parts on one "
            "another reach 0.80 m",
        ),
        (0.2, "inside the table, which is 0.7 m high"),
    ],
)
def test_a_height_at_which_nothing_could_stand_is_told_with_its_line(
    z: float | None, why: str | None
) -> None:
    at = "{x: 0.5, y: 0.0}" if z is None else f"{{x: 0.5, y: 0.0, z: {z}}}"
    text = GOOD.replace("{act: steal, object: pink_bar}", f"{{act: move, object: cup, to: {at}}}")
    read = read_scenario_text(text.replace("tree: eket\n", f"tree: eket\nscene:\n  cup: {at}\n"))
    cup = SceneObject(color=(1.0, 0.0, 0.0), size=(0.1, 0.1, 0.1), pose=Pose(x=0.5, y=0.0))
    scene = Scene(name="tea", objects={"cup": cup, "pink_bar": cup}, places={})
    found = find_misfits(read.scenario, TREE, scene, {"pick_and_place": 8})
    assert [read.problem(each).describe("mine.yaml") for each in found] == (
        []
        if why is None
        else [
            f"mine.yaml:{line}: {where} puts 'cup' at a height of {z:g} m, {why}"
            for line, where in ((4, "scene.cup.z"), (7, "interventions[0].do.to.z"))
        ]
    )


def test_names_that_the_scene_has_not_are_told() -> None:
    cup = SceneObject(color=(1.0, 0.0, 0.0), size=(0.1, 0.1, 0.1), pose=Pose(x=0.5, y=0.0))
    scene = Scene(name="tea", objects={"cup": cup}, places={"tray": Place(pose=cup.pose)})
    scenario = Scenario.model_validate_json(
        json.dumps(
            {
                "name": "short",
                "tree": "tea",
                "scene": {"cup": {"x": 0.5, "y": 0.1}, "pot": {"x": 0.5, "y": 0.1}},
                "interventions": [
                    {
                        "when": {"object": "milk", "step": 2},
                        "do": {"act": "place", "object": "jug", "place": "shelf"},
                    },
                    {"at_s": 3, "do": {"act": "block"}},
                ],
            }
        )
    )
    assert [each.message for each in find_misfits(scenario, TREE, scene, {})] == [
        "scene names the object 'pot', which the scene 'tea' has not",
        "interventions[0].when names the object 'milk', which the scene 'tea' has not",
        "interventions[0].do names the object 'jug', which the scene 'tea' has not",
        "interventions[0].do names the place 'shelf', which the scene 'tea' has not",
    ]


@pytest.mark.parametrize(
    ("step", "counts", "misfits"),
    [
        (8, {"pick_and_place": 8}, []),
        (
            12,
            {"pick_and_place": 8},
            [
                "mine.yaml:4: interventions[0].when names step 12 for 'pink_bar', but "
                "'pick_and_place' has the steps 1 to 8"
            ],
        ),
        (12, {"pick_and_place": None}, []),
        (12, {}, []),
    ],
)
def test_a_step_that_no_behavior_of_the_object_has_is_told_with_its_line(
    step: int, counts: dict[str, int | None], misfits: list[str]
) -> None:
    read = read_scenario_text(GOOD.replace("step: 5", f"step: {step}"))
    found = find_misfits(read.scenario, TREE, None, counts)
    assert [read.problem(each).describe("mine.yaml") for each in found] == misfits


@pytest.mark.parametrize("step", [1, 12])
def test_a_step_of_what_no_leaf_handles_is_told_with_its_line(step: int) -> None:
    text = GOOD.replace("{object: pink_bar, step: 5", f"{{object: green_leg, step: {step}")
    read = read_scenario_text(text)
    found = find_misfits(read.scenario, TREE, None, {"pick_and_place": 8})
    assert [read.problem(each).describe("mine.yaml") for each in found] == [
        "mine.yaml:4: interventions[0].when waits for a step with 'green_leg', which no leaf of "
        "the task tree 'eket' handles; name an object that one handles (pink_bar), or a time (at_s)"
    ]


def test_what_befalls_an_object_that_no_leaf_handles_is_no_mistake() -> None:
    text = GOOD.replace("{act: steal, object: pink_bar}", "{act: steal, object: green_leg}")
    text = text.replace("answers:", "  - at_s: 3.0\n    do: {act: steal, object: cup}\nanswers:")
    scenario = check_scenario_text(text, source="mine.yaml")
    assert find_misfits(scenario, TREE, None, {"pick_and_place": 8}) == []


def test_what_the_scene_has_not_is_told_with_its_line() -> None:
    scene = Scene(name="bare", objects={}, places={})
    text = GOOD + "scene:\n  pink_bar: {x: 0.5, y: 0.1}\n"
    read = read_scenario_text(text)
    found = [read.problem(each) for each in find_misfits(read.scenario, TREE, scene, {})]
    assert [each.line for each in found] == [9, 4, 5]


def test_the_papers_thefts_are_those_of_its_section_4_1() -> None:
    scenario = built_in_scenario("eket_paper")
    assert [(each.when, each.do.act) for each in scenario.interventions] == [
        (Trigger(object="pink_bar", step=5, fraction=0.9), Act.STEAL),
        (Trigger(object="yellow_bar", step=4, fraction=0.8), Act.STEAL),
        (Trigger(object="blue_leg", step=2, fraction=0.9), Act.STEAL),
    ]
    assert list(scenario.scene) == ["purple_top"]
