"""Scenario files are read strictly, and every mistake is told with its line."""

import json
from pathlib import Path

import pytest

from tasks.intervention import Act
from tasks.scenario import Scenario, Trigger
from tasks.scenario_file import (
    ScenarioFileError,
    load_scenario,
    parse_scenario,
    read_scenario,
    scenario_names,
    scene_problems,
)
from tasks.scene import Place, Pose, Scene, SceneObject

GOOD = """\
name: short
tree: eket
interventions:
  - when: {object: pink_bar, step: 5, fraction: 0.5}
    do: {act: steal, object: pink_bar}
answers: [no, yes, silence]
person: {acts: false}
"""


def problems_of(text: str) -> list[str]:
    with pytest.raises(ScenarioFileError) as caught:
        parse_scenario(text, "mine.yaml")
    return caught.value.problems


@pytest.mark.parametrize("name", scenario_names())
def test_every_scenario_that_comes_with_mend_is_sound(name: str) -> None:
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario.description


def test_plain_yes_and_no_are_answers_and_true_and_false_are_not() -> None:
    scenario = parse_scenario(GOOD, "mine.yaml")
    assert scenario.answers == ["no", "yes", "silence"]
    assert scenario.person.acts is False


def test_a_scenario_may_be_written_in_json() -> None:
    scenario = parse_scenario(GOOD, "mine.yaml")
    as_json = json.dumps(scenario.model_dump(mode="json", exclude_defaults=True))
    assert parse_scenario(as_json, "mine.json") == scenario


def test_a_scenario_is_read_from_a_file_of_anybodys(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(GOOD)
    assert read_scenario(path) == parse_scenario(GOOD, "mine.yaml")


def test_an_unknown_scenario_is_told_with_those_that_there_are() -> None:
    with pytest.raises(ScenarioFileError, match=r"there are .*eket_paper"):
        load_scenario("eket_papr")


def test_a_name_never_leads_to_another_file(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(GOOD)
    with pytest.raises(ScenarioFileError, match="there is no such scenario"):
        load_scenario(str(path))


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(ScenarioFileError, match="cannot be read"):
        read_scenario(tmp_path / "mine.yaml")


def test_a_file_that_is_no_text_is_told(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScenarioFileError, match="cannot be read"):
        read_scenario(path)


def test_every_mistake_is_told_with_its_line() -> None:
    text = GOOD.replace("step: 5", "step: 0").replace("silence", "perhaps") + "helpers: [ana]\n"
    assert problems_of(text) == [
        "line 4: interventions.0.when.step: Input should be greater than or equal to 1",
        "line 6: answers.2: Input should be 'yes', 'no' or 'silence'",
        "line 8: helpers: Extra inputs are not permitted",
    ]


def test_an_act_without_what_it_needs_is_told() -> None:
    text = GOOD.replace("{act: steal, object: pink_bar}", "{act: move, object: pink_bar}")
    assert problems_of(text) == ["line 5: interventions.0.do: act 'move' needs a pose 'to'"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "the file is empty"),
        ("- 1", "line 1: the file: Input should be a valid dictionary"),
        ("name: [", "line 1: expected the node content"),
        ("name: a\nname: b", "line 2: 'name' is there twice"),
        ("a: &many [1]\nb: *many", "line 2: aliases (*) are not allowed"),
        ("[" * 30, "nested deeper than 20"),
        ("? [a]\n: 1", "line 1: found unhashable key"),
        ("a: !!python/object:os.system x", "line 1: tags (!) are not allowed here"),
        ("when: 2020-99-99", "month must be"),
        ("a: \x01", "special characters are not allowed"),
    ],
)
def test_what_cannot_be_read_is_told_in_one_sentence(text: str, problem: str) -> None:
    (only,) = problems_of(text)
    assert problem in only


def test_a_file_of_unreasonable_size_is_refused() -> None:
    assert problems_of(f"description: {'a' * 300_000}") == ["the file is larger than 256 KiB"]


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
    assert scene_problems(scenario, scene) == [
        "scene names the object 'pot', which the scene 'tea' has not",
        "interventions[0].when names the object 'milk', which the scene 'tea' has not",
        "interventions[0].do names the object 'jug', which the scene 'tea' has not",
        "interventions[0].do names the place 'shelf', which the scene 'tea' has not",
    ]


def test_the_papers_thefts_are_those_of_its_section_4_1() -> None:
    scenario = load_scenario("eket_paper")
    assert [(each.when, each.do.act) for each in scenario.interventions] == [
        (Trigger(object="pink_bar", step=5, fraction=0.9), Act.STEAL),
        (Trigger(object="yellow_bar", step=5, fraction=0.05), Act.STEAL),
        (Trigger(object="blue_leg", step=2, fraction=0.9), Act.STEAL),
    ]
    assert list(scenario.scene) == ["purple_top"]
