"""Trees are taken with the scene that they name: from a folder of the user's, or the library."""

from pathlib import Path

import pytest

from server.errors import InvalidError
from server.library import Scenes, check_uploaded_tree
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
