"""What the chain cannot find: it is no signature, and docs/journal.md says so."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from checked_journal import checked
from made_up_history import run_id, write_history

from mend.server.journal.chain import chain_anew

RUNS = 3


@pytest.fixture
def journal(tmp_path: Path) -> Path:
    path = tmp_path / "journal.db"
    write_history(path, RUNS, pictures=False)
    return path


def test_who_makes_the_chain_anew_leaves_no_trace(journal: Path) -> None:
    with closing(sqlite3.connect(journal)) as connection, connection:
        connection.execute("UPDATE events SET body = replace(body, 'anna', 'bert')")
        connection.execute("DELETE FROM batches")
        chain_anew(connection)
    assert checked(journal).findings == []


def test_an_end_that_was_cut_off_leaves_no_trace(journal: Path) -> None:
    last = str(run_id(RUNS - 1))
    with closing(sqlite3.connect(journal)) as connection, connection:
        (begun,) = connection.execute(
            "SELECT min(seq) FROM events WHERE run = ?", (last,)
        ).fetchone()
        assert connection.execute("DELETE FROM events WHERE seq >= ?", (begun,)).rowcount > 0
        connection.execute("DELETE FROM batches WHERE last >= ?", (begun,))
        for table in ("runs", "dialogues"):
            connection.execute(f"DELETE FROM {table} WHERE run = ?", (last,))
    check = checked(journal)
    assert check.findings == []
    assert check.runs == RUNS - 1
