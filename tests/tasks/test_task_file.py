"""Reading task files: both forms, and every mistake told with its line and node."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample
from trees import BEHAVIORS

from mend.documents.problem import InvalidFileError
from mend.tasks import nested_form
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.draft import MAX_NODE_DEPTH, MAX_NODES
from mend.tasks.library import SCENES, TREES, NotInLibraryError, Shelf
from mend.tasks.scene_file import built_in_scene
from mend.tasks.task_file import CheckedTask, check_built_in_task, check_task_file, check_task_text
from mend.tasks.task_tree import TaskTree

LEAF = "{behavior: pick_and_place, object: a, place: b}"


def check(text: str) -> CheckedTask:
    return check_task_text(text, BEHAVIORS)


def problems(text: str) -> list[tuple[int | None, str | None, str]]:
    with pytest.raises(InvalidFileError) as caught:
        check(text)
    return [(each.line, each.node_path, each.message) for each in caught.value.problems]


def test_the_nested_form_becomes_a_tree() -> None:
    definition = check(TREES.read("eket")).definition
    tree = TaskTree(definition)
    assert [tree.kind_of(i) for i in range(len(tree))] == [
        "then", "behavior", "and", "behavior", "behavior", "behavior", "or", "behavior", "behavior",
    ]  # fmt: skip
    assert [tree.name_of(i) for i in tree.leaves] == [
        "green_leg", "pink_bar", "yellow_bar", "blue_leg", "purple_top", "orange_top",
    ]  # fmt: skip
    assert definition.scene == "eket"


def test_a_leaf_needs_help_where_it_or_else_its_object_says_so() -> None:
    text = """
name: t
scene: eket
tree:
  and:
    - {behavior: pick_and_place, object: blue_leg, place: blue_leg}
    - {behavior: pick_and_place, object: yellow_bar, place: yellow_bar, needs_help: false}
    - {behavior: pick_and_place, object: green_leg, place: green_leg, needs_help: true}
    - {behavior: pick_and_place, object: pink_bar, place: pink_bar}
"""
    tree = TaskTree(check(text).definition)
    helped = [tree.leaf_definition(i).needs_help for i in tree.leaves]
    assert helped == [True, False, True, False]


def test_json_is_read_as_well() -> None:
    leaf = {"behavior": "pick_and_place", "object": "a", "place": "b"}
    text = json.dumps({"name": "t", "description": "\U0001f916 \\ud83d", "tree": {"or": [leaf]}})
    assert check(text).definition.description == "\U0001f916 \\ud83d"


def test_names_that_would_be_equal_get_a_number() -> None:
    text = f"{{name: t, tree: {{or: [{LEAF}, {LEAF}, {{or: [{LEAF}]}}]}}}}"
    names = [node.name for node in check(text).definition.nodes]
    assert names == ["or", "a", "a_2", "or_2", "a_3"]


def test_every_mistake_is_told_at_once_in_the_order_of_lines() -> None:
    text = """\
name: t
scene: eket
tree:
  then:
    - and: []
    - or: green_leg
    - {then: [], or: []}
    - green_leg
    - behavior: pick_and_place
      object: 5
      plce: blue_leg
    - {behavior: jump, name: high}
    - behavior: pick_and_place
      object: red_leg
      place: nowhere
      name: high
    - {behavior: [], extra: 1}
    -
    - name: 7th
      and:
        - {object: green_leg}
      colour: red
author: me
"""
    assert [(line, path) for line, path, _ in problems(text)] == [
        (5, "/0"), (6, "/1"), (7, "/2"), (8, "/3"), (9, "/4"), (10, "/4"), (11, "/4"), (12, "/5"),
        (14, "/6"), (15, "/6"), (16, "/6"), (17, "/7"), (18, "/8"), (19, "/9"), (21, "/9/0"),
        (22, "/9"), (23, None),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        ("{and: []}", "'and' is empty; a goal node needs a child"),
        ("{or: 5}", "'or' must be a list of nodes, but it is 5"),
        ("{then: [], or: []}", "this one has 'then' and 'or'"),
        ("{name: a}", "a node needs one of 'then', 'and', 'or' or 'behavior'"),
        ("5", "a node is a mapping with one of"),
        ("{behavior: jump}", "unknown behavior 'jump'; there are 'pick_and_place'"),
        ("{behavior: pick_and_place, object: a}", "'place' is missing"),
        ("{behavior: pick_and_place, object: 5, place: b}", "'object' must be text"),
        (
            "{behavior: pick_and_place, object: a, place: b, spee: 1}",
            "unknown key 'spee'; 'pick_and_place' may have 'needs_help', 'object', 'place'",
        ),
        (f"{{and: [{LEAF}], speed: 1}}", "unknown key 'speed'; a goal node has 'and'"),
        (f"{{name: 7, and: [{LEAF}]}}", "'name' must be a letter, then"),
        (f"{{name: x, name: y, and: [{LEAF}]}}", "the key 'name' is given twice, first in line 2"),
    ],
)
def test_one_mistake_is_one_sentence(tree: str, message: str) -> None:
    ((_, _, told),) = problems(f"name: t\ntree: {tree}")
    assert message in told


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "a task file is a mapping, but this is empty"),
        ("- a", "a task file is a mapping, but this is a list"),
        (f"tree: {LEAF}", "'name' is missing"),
        ("name: t", "'tree' is missing"),
        (f"name: t\nscene: moon\ntree: {LEAF}", "there is no scene 'moon' in the library"),
        (f"name: t\nscene: 5\ntree: {LEAF}", "'scene' must be text, but it is 5"),
        ("a: b: c", "the text is not valid YAML or JSON"),
        ('{"name": ', "the text is not valid YAML or JSON"),
        ("\x00", "the text is not valid YAML or JSON"),
        ("name: t\ntree:\n\tand: []", "YAML is indented with spaces, and here is a tab"),
        ("x: &x {a: 1}\nname: t\ntree: {<<: *x}", "'<<' merges nothing here"),
        ("name: t\ntree: {behaviour: go}", "is 'behaviour' meant to be 'behavior'?"),
    ],
)
def test_a_file_without_a_tree_is_told_so(text: str, message: str) -> None:
    ((_, _, told),) = problems(text)
    assert message in told


def test_an_error_reads_as_file_line_node_and_sentence(tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text("name: t\ntree:\n  and:\n    - or: []\n")
    with pytest.raises(InvalidFileError) as caught:
        check_task_file(path, BEHAVIORS)
    assert str(caught.value) == f"{path}:4: /0: 'or' is empty; a goal node needs a child"


def test_a_file_that_cannot_be_read_is_told_so(tmp_path: Path) -> None:
    with pytest.raises(InvalidFileError, match="cannot be read: No such file"):
        check_task_file(tmp_path / "none.yaml", BEHAVIORS)
    (tmp_path / "binary.yaml").write_bytes(b"name: \xff")
    with pytest.raises(InvalidFileError, match="not UTF-8 text \\(byte 6\\)"):
        check_task_file(tmp_path / "binary.yaml", BEHAVIORS)


def test_a_scene_beside_the_file_comes_before_the_library(tmp_path: Path) -> None:
    (tmp_path / "scenes").mkdir()
    scene = "name: eket\nobjects: {}\nplaces: {}\n"
    (tmp_path / "scenes" / "eket.yaml").write_text(scene)
    (tmp_path / "t.yaml").write_text(TREES.read("eket"))
    with pytest.raises(InvalidFileError, match="the scene 'eket' has no object 'green_leg'"):
        check_task_file(tmp_path / "t.yaml", BEHAVIORS)


def test_every_mistake_of_its_scene_is_told(tmp_path: Path) -> None:
    (tmp_path / "scenes").mkdir()
    (tmp_path / "t.yaml").write_text(TREES.read("eket"))
    (tmp_path / "scenes" / "eket.yaml").write_text("name: 5\nobjects: {}\nplace: {}\n")
    with pytest.raises(InvalidFileError) as caught:
        check_task_file(tmp_path / "t.yaml", BEHAVIORS)
    told = [each.message for each in caught.value.problems if "has a mistake" in each.message]
    assert len(told) == 3
    assert all(each.startswith("the scene 'eket' has a mistake: ") for each in told)
    assert any("eket.yaml:3: unknown key 'place'" in each for each in told)


def test_of_a_scene_that_is_nowhere_it_is_told_which_file_was_looked_for(tmp_path: Path) -> None:
    path = tmp_path / "t.yaml"
    path.write_text(f"name: t\nscene: moon\ntree: {LEAF}")
    with pytest.raises(InvalidFileError) as caught:
        check_task_file(path, BEHAVIORS)
    [problem] = caught.value.problems
    assert problem.line == 2
    assert problem.message.startswith("there is no scene 'moon' in the library; it has ")
    beside = tmp_path / "scenes" / "moon.yaml"
    assert problem.message.endswith(f", nor is there a file '{beside}'")


def nested(depth: int) -> str:
    return "{name: t, tree: " + "{then: [" * (depth - 1) + LEAF + "]}" * (depth - 1) + "}"


def test_a_deep_tree_is_read_and_one_beyond_the_limit_refused_without_recursion() -> None:
    assert len(check(nested(MAX_NODE_DEPTH)).definition.nodes) == MAX_NODE_DEPTH
    for depth in (MAX_NODE_DEPTH + 1, 1_900):
        [(_, path, message)] = problems(nested(depth))
        assert path is None
        assert message == f"nodes stand inside one another in more than {MAX_NODE_DEPTH} levels"


@pytest.mark.slow(3)
def test_very_many_nodes_are_read_and_beyond_the_limit_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    count = sample(2_000, 100_000)
    most = sample(5_000, MAX_NODES)
    monkeypatch.setattr(nested_form, "MAX_NODES", most)
    leaves = [
        {"behavior": "pick_and_place", "object": f"a{number}", "place": f"b{number}"}
        for number in range(count)
    ]
    text = json.dumps({"name": "t", "tree": {"and": leaves}})
    assert len(check(text).definition.nodes) == count + 1
    text = json.dumps({"name": "t", "tree": {"and": [{"and": []}] * most}})
    assert (1, None, f"the tree has more than {most} nodes") in problems(text)


@settings(max_examples=100, deadline=None)
@given(st.text(alphabet="abnt:-[]{}\n ,&*!|>'\"#%@`?0.~", max_size=60))
def test_no_text_ever_breaks_the_reader(text: str) -> None:
    with pytest.raises(InvalidFileError):
        check(text)


@pytest.mark.parametrize("name", TREES.names())
def test_every_tree_of_the_library_is_right(name: str) -> None:
    task = check_built_in_task(name, BEHAVIORS)
    assert task.definition.name == task.definition.scene == name
    assert task.scene == built_in_scene(name)


def test_the_workshop_holds_every_nesting_and_over_forty_leaves() -> None:
    tree = TaskTree(check_built_in_task("workshop", BEHAVIORS).definition)
    pairs = {
        (tree.kind_of(parent), tree.kind_of(node))
        for node in range(1, len(tree))
        if (parent := tree.parent_of(node)) is not None
    }
    goals = ("then", "and", "or")
    assert {(outer, inner) for outer in goals for inner in goals} <= pairs
    assert len(tree.leaves) >= 40


def test_the_library_tells_what_it_has() -> None:
    with pytest.raises(NotInLibraryError, match="no scene 'moon' in the library; it has 'eket'"):
        SCENES.read("moon")
    with pytest.raises(NotInLibraryError):
        TREES.read("../scenes/eket")
    assert Shelf("nowhere", "nothing").names() == []


def test_a_leaf_says_what_autonomy_it_needs() -> None:
    text = """
name: careful
tree:
  and:
    - {behavior: pick_and_place, object: cup, place: left}
    - {behavior: pick_and_place, object: jug, place: right, autonomy: full}
"""
    checked = check_task_text(text, BEHAVIORS)
    leaves = [each for each in checked.definition.nodes if isinstance(each, BehaviorNode)]
    assert [each.autonomy for each in leaves] == ["off", "full"]
    assert leaves[1].parameters == {"object": "jug", "place": "right", "needs_help": False}
    kept = checked.definition.to_json()
    assert ["autonomy" in each for each in kept["nodes"]] == [False, False, True]
    tree = TaskTree(TaskTreeDefinition.model_validate(kept))
    assert [str(tree.nodes.autonomy_of(leaf)) for leaf in tree.leaves] == ["off", "full"]


def test_an_autonomy_that_there_is_not_is_a_mistake_in_its_line() -> None:
    text = """
name: careful
tree:
  and:
    - behavior: pick_and_place
      object: cup
      place: left
      autonomy: some
"""
    assert problems(text) == [(8, "/0", "'autonomy' must be low, high or full, but it is \"some\"")]
