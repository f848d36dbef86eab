"""Scene files and the JSON Schemas of all files."""

import json
from pathlib import Path

import jsonschema_rs
import pytest
from trees import BEHAVIORS

from mend.documents.document import read_document
from mend.documents.problem import InvalidFileError
from mend.tasks.json_schema import scenario_schema, scene_schema, task_schema
from mend.tasks.library import SCENES, TREES, NotInLibraryError
from mend.tasks.scene_file import (
    built_in_scene,
    check_scene_file,
    check_scene_text,
    read_scene_text,
)

SCENE = """\
name: s
objects:
  cup:
    color: [1, 0.5, 0]
    size: [0.03, 0.05, 0.05]
    pose: {x: 0.5, y: 0.1}
places:
  shelf: {pose: {x: 0.6, y: 0.2, z: 0.9}}
"""


def told(text: str) -> list[str]:
    with pytest.raises(InvalidFileError) as caught:
        check_scene_text(text, source="s")
    return str(caught.value).splitlines()


def test_a_scene_is_read() -> None:
    scene = check_scene_text(SCENE)
    assert scene.objects["cup"].color == (1.0, 0.5, 0.0)
    assert scene.places["shelf"].pose.z == 0.9


def test_every_mistake_is_told_with_its_line() -> None:
    text = SCENE.replace("0.5, 0]", "2, 0]").replace("x: 0.5,", "x: left,")
    text = text.replace("shelf:", "7th:").replace("name: s", "name: s\nlight: on")
    lines = told(text)
    assert lines == [
        "s:2: unknown key 'light'; known are 'name', 'objects', 'places', 'robots', 'scatter', "
        "'setting', 'table'",
        "s:5: 'objects.cup.color.1' must be less than or equal to 1, but it is 2",
        "s:7: 'objects.cup.pose.x' must be a number (in metres), but it is \"left\"",
        "s:9: 'places.7th' must be a name: a letter, then at most 63 letters, digits, '_' or '-', "
        'but it is "7th"',
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "s:1: a scene file is a mapping, but this is empty"),
        ("name: s\nplaces: {}", "s:1: 'objects' is missing"),
        ("a: [", "not valid YAML or JSON"),
        (
            SCENE.replace("[1, 0.5, 0]", "red"),
            "'objects.cup.color' must be a list of red, green and blue, each from 0 to 1, "
            'but it is "red"',
        ),
    ],
)
def test_what_is_no_scene_is_told_so(text: str, message: str) -> None:
    assert any(message in line for line in told(text))


def test_a_scene_file_that_is_not_there_is_told_so(tmp_path: Path) -> None:
    with pytest.raises(InvalidFileError, match="cannot be read"):
        check_scene_file(tmp_path / "none.yaml")


@pytest.mark.parametrize("name", SCENES.names())
def test_every_scene_of_the_library_is_right(name: str) -> None:
    scene = built_in_scene(name)
    assert scene.name == name
    kinds = {(each.size, each.knob, each.color) for each in scene.objects.values()}
    assert len({color for _, _, color in kinds}) == len(kinds)


def test_the_schemas_take_the_library_and_refuse_mistakes() -> None:
    scene_check = jsonschema_rs.validator_for(scene_schema())
    task_check = jsonschema_rs.validator_for(task_schema(BEHAVIORS))
    for name in SCENES.names():
        assert scene_check.is_valid(json.loads(json.dumps(read_document(SCENES.read(name))[0])))
    for name in TREES.names():
        assert task_check.is_valid(json.loads(json.dumps(read_document(TREES.read(name))[0])))
    assert not task_check.is_valid({"name": "t", "tree": {"and": []}})
    assert not task_check.is_valid({"name": "t", "tree": {"behavior": "jump"}})
    assert not scene_check.is_valid({"name": "s", "objects": {}})
    jsonschema_rs.validator_for(scenario_schema())


ROW = """\
name: s
objects:
  bolt:
    color: [1, 0.5, 0]
    size: [0.03, 0.05, 0.05]
    poses:
      - {x: 0.5, y: 0.1}
      - {x: 0.5, y: 0.2}
places:
  bolt:
    grid: {first: {x: 0.4, y: -0.1}, rows: 2, columns: 2, step: [0.1, 0.05]}
  shelf: {pose: {x: 0.6, y: 0.2, z: 0.9}}
"""


def test_several_poses_stand_for_several_equal_parts() -> None:
    scene = check_scene_text(ROW)
    assert list(scene.objects) == ["bolt_1", "bolt_2"]
    assert scene.objects["bolt_1"].size == scene.objects["bolt_2"].size
    assert [each.pose.y for each in scene.objects.values()] == [0.1, 0.2]


def test_a_grid_stands_for_its_rows_and_columns() -> None:
    places = check_scene_text(ROW).places
    assert list(places) == ["bolt_1", "bolt_2", "bolt_3", "bolt_4", "shelf"]
    assert [(each.pose.x, each.pose.y) for each in places.values()][:4] == [
        (0.4, -0.1),
        (0.4, -0.05),
        (0.5, -0.1),
        (0.5, -0.05),
    ]


def test_mistakes_in_several_poses_are_told_with_their_lines() -> None:
    assert told(ROW.replace("{x: 0.5, y: 0.2}", "{x: left, y: 0.2}")) == [
        "s:8: 'objects.bolt_2.pose.x' must be a number (in metres), but it is \"left\""
    ]
    assert told(ROW.replace("rows: 2", "rows: 0")) == [
        "s:11: the grid of 'bolt': 'rows' must be greater than or equal to 1, but it is 0"
    ]
    assert told(ROW.replace("shelf: {", "bolt_2: {")) == [
        "s:12: there are two 'bolt_2', the other one from line 11"
    ]
    assert told(ROW.replace("poses:", "pose: {x: 0, y: 0}\n    poses:")) == [
        "s:7: 'bolt' has 'pose' and 'poses'; it may have only one of them"
    ]
    assert told(ROW.replace("grid: {first", "grid: 4 #"))[0] == (
        "s:11: 'grid' of 'bolt' must be a mapping, but it is 4"
    )


def test_the_line_of_each_of_several_parts_is_known() -> None:
    read = read_scene_text(ROW)
    assert read.line_of(("objects", "bolt_2", "pose")) == 8
    assert read.line_of(("objects", "bolt_2", "size")) == 5
    assert read.line_of(("places", "bolt_3", "pose", "x")) == 11


def test_the_schema_takes_several_poses() -> None:
    check = jsonschema_rs.validator_for(scene_schema())
    assert check.is_valid(json.loads(json.dumps(read_document(ROW)[0])))
    assert not check.is_valid(json.loads(json.dumps(read_document(ROW.replace("poses", "po"))[0])))


def test_an_unknown_name_is_told_in_a_short_sentence() -> None:
    with pytest.raises(NotInLibraryError) as told:
        SCENES.read("x" * 100_000)
    assert len(str(told.value)) < 400


def test_of_an_unknown_key_deep_inside_the_known_ones_are_told() -> None:
    text = "name: s\nobjects: {}\nplaces: {p: {pose: {x: 0.5, y: 0.1, roll: 1.0}}}\n"
    with pytest.raises(InvalidFileError) as caught:
        check_scene_text(text)
    assert "unknown key 'places.p.pose.roll'; known are 'x', 'y', 'yaw', 'z'" in str(caught.value)
