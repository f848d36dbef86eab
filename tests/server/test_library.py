"""Trees are taken with the scene that they name: from a folder of the user's, or the library."""

from pathlib import Path

import pytest

from server.errors import InvalidError
from server.library import Scenes, check_uploaded_tree
from server.trees import WrongTreeError
from tasks.library import SCENES, NotInLibraryError

TREE = """\
name: mine
scene: bench
tree: {behavior: pick_and_place, object: cup, place: tray}
"""
SCENE = """\
name: bench
objects: {cup: {color: [1.0, 0.0, 0.0], size: [0.05, 0.05, 0.05], pose: {x: 0.5, y: -0.2}}}
places: {tray: {pose: {x: 0.5, y: 0.0}}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "bench.yaml").write_text(SCENE)
    return tmp_path


def test_a_scene_of_the_folder_is_found_before_the_library(folder: Path) -> None:
    assert Scenes(folder).find("bench").objects.keys() == {"cup"}
    assert Scenes(folder).find("eket").name == "eket"


@pytest.mark.parametrize("name", ["../bench", "/etc/passwd", "bench.yaml", ""])
def test_a_name_never_leads_out_of_the_folder(folder: Path, name: str) -> None:
    inner = folder / "inner"
    inner.mkdir()
    with pytest.raises(NotInLibraryError):
        Scenes(inner).find(name)


def test_a_tree_is_checked_against_the_scene_of_the_folder(folder: Path) -> None:
    assert check_uploaded_tree(TREE, Scenes(folder)).name == "mine"
    with pytest.raises(InvalidError) as caught:
        check_uploaded_tree(TREE.replace("cup", "pot"), Scenes(folder))
    assert any("pot" in problem for problem in caught.value.problems)
    with pytest.raises(InvalidError) as caught:
        check_uploaded_tree(TREE, Scenes(None))
    assert any("bench" in problem for problem in caught.value.problems)


def test_every_scene_of_the_library_is_found_without_a_folder() -> None:
    assert [Scenes(None).find(name).name for name in SCENES.names()] == SCENES.names()


def test_every_mistake_of_a_tree_says_where_it_is(folder: Path) -> None:
    text = TREE.replace("pick_and_place", "pick_and_plac") + "nonsense: 1\n"
    with pytest.raises(WrongTreeError) as wrong:
        check_uploaded_tree(text, Scenes(folder))
    lines = text.splitlines()
    assert len(wrong.value.mistakes) == len(wrong.value.problems) == 2
    for mistake in wrong.value.mistakes:
        assert mistake.line is not None
        assert mistake.column == 1
        assert lines[mistake.line - 1]
    assert {each.node for each in wrong.value.mistakes} == {"/", None}


def test_a_list_item_is_pointed_at_after_its_dash_and_broken_yaml_where_it_breaks() -> None:
    nested = "name: x\ntree:\n  then:\n    - {behavior: nothing}\n"
    with pytest.raises(WrongTreeError) as wrong:
        check_uploaded_tree(nested, Scenes(None))
    assert (wrong.value.mistakes[0].line, wrong.value.mistakes[0].column) == (4, 7)
    with pytest.raises(WrongTreeError) as broken:
        check_uploaded_tree("name: x\ntree: }\n", Scenes(None))
    assert (broken.value.mistakes[0].line, broken.value.mistakes[0].column) == (2, 7)
