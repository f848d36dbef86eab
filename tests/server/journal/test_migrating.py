"""A new journal has all of its tables or none; an old one keeps each version that it came to."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing

import pytest

from mend.server.journal import migrations
from mend.server.journal.migrations import MIGRATIONS, Migration, migrate


@pytest.fixture
def connection() -> Iterator[sqlite3.Connection]:
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
        yield connection


def break_last(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = Migration(MIGRATIONS[-1].statements + "INSERT INTO nowhere VALUES (1);\n")
    monkeypatch.setattr(migrations, "MIGRATIONS", (*MIGRATIONS[:-1], broken))


def versions(connection: sqlite3.Connection) -> list[int]:
    found = connection.execute("SELECT version FROM schema_version ORDER BY version")
    return [version for (version,) in found]


def tables(connection: sqlite3.Connection) -> set[str]:
    found = connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table'")
    return {name for (name,) in found}


def test_a_new_journal_that_cannot_be_made_has_nothing_and_is_made_the_next_time(
    connection: sqlite3.Connection,
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        break_last(patch)
        with pytest.raises(sqlite3.OperationalError, match="nowhere"):
            migrate(connection)
    assert (versions(connection), tables(connection)) == ([], {"schema_version"})
    migrate(connection)
    assert versions(connection) == list(range(1, len(MIGRATIONS) + 1))
    assert {"events", "documents", "runs", "picks"} <= tables(connection)


def test_an_old_journal_keeps_the_versions_before_the_one_that_cannot_be_made(
    connection: sqlite3.Connection,
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(migrations, "MIGRATIONS", MIGRATIONS[:2])
        migrate(connection)
    with pytest.MonkeyPatch.context() as patch:
        break_last(patch)
        with pytest.raises(sqlite3.OperationalError, match="nowhere"):
            migrate(connection)
    assert versions(connection) == list(range(1, len(MIGRATIONS)))
    migrate(connection)
    assert versions(connection) == list(range(1, len(MIGRATIONS) + 1))
