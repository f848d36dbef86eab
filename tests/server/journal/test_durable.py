"""What is committed or copied is on the disk before anybody relies on it."""

import os
import sqlite3
from pathlib import Path
from typing import Any

import pytest
from made_up_history import write_history

from mend.server.journal.backup import back_up, restore
from mend.server.journal.opening import open_journal

FULL = 2


def test_commits_wait_for_the_disk_however_sqlite_was_built(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    connect = sqlite3.connect

    def as_some_are_built(*arguments: Any, **more: Any) -> sqlite3.Connection:
        connection = connect(*arguments, **more)
        connection.execute("PRAGMA synchronous=NORMAL")
        return connection

    monkeypatch.setattr("mend.server.journal.opening.sqlite3.connect", as_some_are_built)
    opened = open_journal(tmp_path / "journal.db", 5.0, 1.0)
    assert opened.write.execute("PRAGMA synchronous").fetchone() == (FULL,)
    assert opened.write.execute("PRAGMA journal_mode").fetchone() == ("wal",)
    for each in (opened.write, opened.read, opened.look_up):
        each.close()
    assert opened.lock is not None
    opened.lock.release()


@pytest.mark.parametrize("copied", [back_up, restore])
def test_a_copy_is_on_the_disk_before_it_takes_its_place_and_its_place_after_that(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, copied: Any
) -> None:
    source, target = tmp_path / "from" / "journal.db", tmp_path / "to" / "journal.db"
    for each in (source, target):
        each.parent.mkdir()
    write_history(source, 1)
    done: list[str] = []
    fsync, replace = os.fsync, Path.replace

    def synced(descriptor: int) -> None:
        done.append(f"fsync {Path(f'/proc/self/fd/{descriptor}').readlink().name}")
        fsync(descriptor)

    def replaced(draft: Path, to: Path) -> Path:
        done.append("replace")
        return replace(draft, to)

    monkeypatch.setattr("mend.server.journal.backup.os.fsync", synced)
    monkeypatch.setattr(Path, "replace", replaced)
    copied(source, target)
    assert done == ["fsync journal.db.draft", "replace", "fsync to"]
