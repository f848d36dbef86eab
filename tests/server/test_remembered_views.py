"""A large document is checked once for all who look at it, and anew where anything has changed."""

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from noon import at_noon

from mend.errors import WrongInputError
from mend.server import remembered_views
from mend.server.fixed_documents import GivenFiles, fixed_documents
from mend.server.journal.sqlite import SqliteJournal
from mend.server.library import Library, build_library
from mend.server.off_loop import MUCH_CHARS
from mend.server.scene_checks import WorldChecks

BENCH = """\
name: bench
objects: {cup: {color: [1.0, 0.1, 0.1], size: [0.05, 0.05, 0.05], pose: {x: 0.5, y: -0.3}}}
places: {tray: {pose: {x: 0.5, y: 0.0}}}
"""
LONG = "# " + "x" * MUCH_CHARS + "\n"
SERVE = "{name: serve, scene: bench, tree: {behavior: pick_and_place, object: cup, place: tray}}"


class Shelf:
    """A library with a folder of scenes, which counts what would be checked in its process."""

    def __init__(self, folder: Path) -> None:
        self.scene = folder / "bench.yaml"
        self.journal = SqliteJournal(":memory:")
        self.checks = 0
        self.library: Library = build_library(
            self.journal,
            fixed_documents(GivenFiles(), folder),
            WorldChecks({}),
            utc_now=at_noon,
        )
        self.library.off_loop.run = self._counted  # type: ignore[method-assign]

    async def _counted(self, chars, work, *args):  # noqa: ARG002
        self.checks += 1
        return await asyncio.to_thread(work, *args)

    async def tree(self, name: str = "serve") -> str:
        return (await self.library.trees.get(name)).view().text

    async def checks_of(self, *names: str) -> int:
        """How many checks it takes to see these."""
        before = self.checks
        await asyncio.gather(*map(self.tree, names))
        return self.checks - before


@pytest.fixture
async def shelf(tmp_path: Path) -> AsyncIterator[Shelf]:
    shelf = Shelf(tmp_path)
    shelf.scene.write_text(BENCH)
    await shelf.library.trees.save("serve", LONG + SERVE)
    yield shelf
    shelf.library.off_loop.close()
    shelf.journal.close()


async def test_a_large_tree_is_checked_once_for_all_who_see_it(shelf: Shelf) -> None:
    assert await shelf.checks_of("serve", "serve", "serve") == 1
    assert await shelf.checks_of("serve") == 0
    assert await shelf.tree() == LONG + SERVE


async def test_a_tree_that_changes_is_checked_anew(shelf: Shelf) -> None:
    await shelf.tree()
    changed = "# changed\n" + LONG + SERVE
    await shelf.library.trees.save("serve", changed)
    assert await shelf.tree() == changed


async def test_a_file_that_a_tree_names_and_that_changes_is_looked_at_again(shelf: Shelf) -> None:
    await shelf.tree()
    shelf.scene.write_text(BENCH.replace("cup:", "mug:"))
    with pytest.raises(WrongInputError, match="mistake"):
        await shelf.tree()
    shelf.scene.write_text(BENCH)
    assert await shelf.checks_of("serve") == 0


async def test_an_uploaded_file_that_a_tree_names_and_that_changes_is_looked_at_again(
    shelf: Shelf,
) -> None:
    shelf.scene.unlink()
    await shelf.library.scenes.save("bench", BENCH)
    assert await shelf.checks_of("serve") == 1
    assert await shelf.checks_of("serve") == 0
    await shelf.library.scenes.save("bench", BENCH.replace("-0.3", "-0.2"))
    assert await shelf.checks_of("serve") == 1


async def test_who_sees_what_is_kept_waits_for_nobody(shelf: Shelf) -> None:
    await shelf.tree()
    async with shelf.library.trees._views._turns.turn(1), asyncio.timeout(20):
        assert await shelf.checks_of("serve") == 0


async def test_what_changes_during_a_check_is_not_remembered(shelf: Shelf) -> None:
    run = shelf.library.off_loop.run

    async def then_changed(chars, work, *args):
        made = await run(chars, work, *args)
        shelf.scene.write_text(BENCH + "# changed\n")
        return made

    shelf.library.off_loop.run = then_changed  # type: ignore[method-assign]
    await shelf.tree()
    shelf.library.off_loop.run = run  # type: ignore[method-assign]
    shelf.scene.write_text(BENCH)
    assert await shelf.checks_of("serve") == 1


async def test_so_much_is_kept_and_no_more(shelf: Shelf, monkeypatch: pytest.MonkeyPatch) -> None:
    await shelf.library.trees.save("other", LONG + SERVE)
    monkeypatch.setattr(remembered_views, "MOST_BYTES", int(1.5 * MUCH_CHARS))
    for name in ("serve", "other"):
        assert await shelf.checks_of(name) == 1
    assert await shelf.checks_of("other") == 0
    assert await shelf.checks_of("serve") == 1


async def test_a_folder_that_cannot_be_read_keeps_nobody_from_a_tree(shelf: Shelf) -> None:
    (shelf.scene.parent / "broken.yaml").write_bytes(b"\xff")
    assert await shelf.checks_of("serve", "serve") == 2
