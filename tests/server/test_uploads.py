"""What checks are given of what was uploaded, and what happens to those who upload at once."""

import asyncio
from collections.abc import AsyncIterator

import httpx
import pytest
from noon import at_noon
from service_under_test import build

from mend.errors import ConflictError
from mend.server.documents import DocumentKind
from mend.server.errors import BusyError
from mend.server.fixed_documents import GivenFiles, fixed_documents
from mend.server.journal.journal import Document, Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.library import Library, build_library
from mend.server.limits import Limits
from mend.server.scene_checks import WorldChecks
from mend.server.uploads import Uploads

TREE, SCENE, SCENARIO = DocumentKind.TREE, DocumentKind.SCENE, DocumentKind.SCENARIO

BENCH = """\
name: bench
objects: {cup: {color: [1.0, 0.1, 0.1], size: [0.05, 0.05, 0.05], pose: {x: 0.5, y: -0.3}}}
places: {tray: {pose: {x: 0.5, y: 0.0}}}
"""
SERVE = "{name: serve, scene: bench, tree: {behavior: pick_and_place, object: cup, place: tray}}"


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


@pytest.fixture
def library(journal: SqliteJournal) -> Library:
    return build_library(
        journal, fixed_documents(GivenFiles(), None), WorldChecks({}), utc_now=at_noon
    )


async def kept(journal: SqliteJournal, **trees_and_scenes: dict[str, str]) -> Uploads:
    for kind, texts in trees_and_scenes.items():
        for name, text in texts.items():
            await journal.append(Entry(document=Document(kind, name, text)))
    given = GivenFiles({TREE: {"given": "scene: given-bench"}})
    return Uploads(journal, fixed_documents(given, None))


SHELF = {
    "tree": {"serve": "scene: bench", "clear": "scene: floor"},
    "scene": {"bench": "b", "floor": "f", "bench2": "2", "given-bench": "g"},
}


@pytest.mark.parametrize(
    ("text", "scenes"),
    [
        ("scene: bench", {"bench"}),
        ('{"scene":"bench"}', {"bench"}),
        ("scene: &x bench2\nthis: *x", {"bench2"}),
        ("scene: 'floor' # not the bench", {"floor", "bench"}),
        ("scene: benches", set()),
        ('scene: "\\x62ench"', SHELF["scene"].keys()),
        ('scene: "ben\\\n  ch"', SHELF["scene"].keys()),
    ],
)
async def test_only_what_a_text_may_name_is_handed_over(
    journal: SqliteJournal, text: str, scenes: set[str]
) -> None:
    uploads = await kept(journal, **SHELF)
    found = await uploads.named_in([text], [SCENE])
    assert {name for name, each in found[SCENE].items() if each} == scenes
    assert found[SCENE].keys() == SHELF["scene"].keys()


@pytest.mark.parametrize(("tree", "scene"), [("serve", "bench"), ("given", "given-bench")])
async def test_what_is_named_may_name_more(journal: SqliteJournal, tree: str, scene: str) -> None:
    uploads = await kept(journal, **SHELF)
    found = await uploads.named_in([f"tree: {tree}"], [TREE, SCENE])
    assert [name for name, each in found[SCENE].items() if each] == [scene]


async def test_what_is_not_there_is_told_with_all_that_is(library: Library) -> None:
    await library.scenes.save("bench", BENCH)
    await library.scenes.save("floor", BENCH)
    checked = (await library.trees.check(SERVE.replace("bench", "roof"))).view()
    assert "there is no scene 'roof'; there are bench, eket" in checked.errors[0].message
    assert "floor" in checked.errors[0].message


async def test_of_two_who_upload_the_same_at_once_one_replaces_the_others(library: Library) -> None:
    first, second = await asyncio.gather(
        library.scenes.save("bench", BENCH), library.scenes.save("bench", BENCH)
    )
    assert (first.new, second.new) == (True, False)


async def test_a_tree_and_its_scene_that_change_at_once_still_fit(library: Library) -> None:
    await library.scenes.save("bench", BENCH)
    outcomes = await asyncio.gather(
        library.trees.save("serve", SERVE),
        library.scenes.save("bench", BENCH.replace("cup:", "mug:")),
        library.scenes.delete("bench"),
        return_exceptions=True,
    )
    assert [type(each) for each in outcomes[1:]] == [ConflictError, ConflictError]
    assert (await library.trees.check(SERVE)).view().errors == []


async def test_who_uploads_when_too_much_waits_is_asked_to_come_back(
    journal: SqliteJournal,
) -> None:
    limits = Limits(waiting_chars=2 * len(BENCH))
    library = build_library(
        journal, fixed_documents(GivenFiles(), None), WorldChecks({}), limits, utc_now=at_noon
    )
    saved = await asyncio.gather(
        *(library.scenes.save(f"b{n}", BENCH) for n in range(3)), return_exceptions=True
    )
    assert [isinstance(each, BusyError) for each in saved] == [False, False, True]
    await library.scenes.save("b3", BENCH)


async def test_over_rest_it_is_told_when_to_come_back(monkeypatch: pytest.MonkeyPatch) -> None:
    service = build()

    async def refuse(*_: object) -> None:
        raise BusyError("too much waits", limit="waiting_chars")

    monkeypatch.setattr(service.app.state.services.trees, "save", refuse)
    async with service.client() as client:
        refused: httpx.Response = await client.put("/api/trees/x", json={"text": ""})
    assert (refused.status_code, refused.headers["retry-after"]) == (503, "5")
    assert service.refusals.counts["waiting_chars"] == 1
    service.journal.close()
