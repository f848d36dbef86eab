"""Documents are found among given files, in a folder of the user's, and in the library."""

from pathlib import Path

import pytest

from mend.server.document_checks import TreeChecker
from mend.server.documents import DocumentKind, WrongDocumentError
from mend.server.fixed_documents import GivenFiles, fixed_documents
from mend.server.scene_checks import WorldChecks
from mend.tasks.library import SCENES, NotInLibraryError

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


def scenes(folder: Path | None, **given: str):
    return fixed_documents(GivenFiles({DocumentKind.SCENE: given}), folder)[DocumentKind.SCENE]


def check(text: str, folder: Path | None):
    checker = TreeChecker(fixed_documents(GivenFiles(), folder), WorldChecks({}))
    return checker.check(text, {DocumentKind.SCENE: {}})


def test_a_given_file_is_found_before_the_folder_and_this_before_the_library(folder: Path) -> None:
    assert scenes(folder).read("bench") == SCENE
    assert scenes(folder, bench="mine").read("bench") == "mine"
    (folder / "eket.yaml").write_text(SCENE)
    assert scenes(folder).read("eket") == SCENE
    assert scenes(None).read("eket") == SCENES.read("eket")
    assert scenes(folder, cup="x").names() == sorted({*SCENES.names(), "bench", "cup"})


@pytest.mark.parametrize("name", ["../bench", "/etc/passwd", "bench.yaml", ""])
def test_a_name_never_leads_out_of_the_folder(folder: Path, name: str) -> None:
    inner = folder / "inner"
    inner.mkdir()
    with pytest.raises(NotInLibraryError):
        scenes(inner).read(name)


def test_a_tree_is_checked_against_the_scene_of_the_folder(folder: Path) -> None:
    assert check(TREE, folder).name == "mine"
    for text, where, what in ((TREE.replace("cup", "pot"), folder, "pot"), (TREE, None, "bench")):
        with pytest.raises(WrongDocumentError) as caught:
            check(text, where)
        assert any(what in problem for problem in caught.value.sentences)


def test_every_mistake_of_a_tree_says_where_it_is(folder: Path) -> None:
    text = TREE.replace("pick_and_place", "pick_and_plac") + "nonsense: 1\n"
    with pytest.raises(WrongDocumentError) as wrong:
        check(text, folder)
    lines = text.splitlines()
    assert len(wrong.value.mistakes) == len(wrong.value.sentences) == 2
    for mistake in wrong.value.mistakes:
        assert mistake.line is not None
        assert mistake.column == 1
        assert lines[mistake.line - 1]
    assert {each.node for each in wrong.value.mistakes} == {"/", None}


def test_a_list_item_is_pointed_at_after_its_dash_and_broken_yaml_where_it_breaks() -> None:
    nested = "name: x\ntree:\n  then:\n    - {behavior: nothing}\n"
    with pytest.raises(WrongDocumentError) as wrong:
        check(nested, None)
    assert (wrong.value.mistakes[0].line, wrong.value.mistakes[0].column) == (4, 7)
    with pytest.raises(WrongDocumentError) as broken:
        check("name: x\ntree: }\n", None)
    assert (broken.value.mistakes[0].line, broken.value.mistakes[0].column) == (2, 7)
