"""The audit says of which deeds the journal's chain does not hold, and its export has the chain."""

import json
import sqlite3
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from made_up_history import write_history
from people import People
from service_under_test import build
from typer.testing import CliRunner, Result

from mend.server.access.roles import Role
from mend.server.cli import app
from mend.server.journal import events as ev
from mend.server.journal.chain import Chain, _linked, chain_anew, digest_of, rows_of
from mend.server.journal.journal import Entry
from mend.server.journal.offline_pruning import prune_file
from mend.server.journal.pruning import Keep
from mend.server.journal.sqlite import SqliteJournal

NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)
NAMES = ("one", "two", "three", "four")
FORGE = "UPDATE events SET body = replace(body, 'olga', 'anna') WHERE seq = ?"


def deleted(name: str) -> Entry:
    olga = ev.Author(principal="olga", role=Role.OPERATOR, address="10.0.0.7")
    return Entry(events=[ev.DocumentDeleted(wall_time=NOW, kind="tree", name=name, author=olga)])


@pytest.fixture
async def path(tmp_path: Path) -> Path:
    """A journal with a deed in each of its batches."""
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path)
    for name in NAMES:
        await journal.append(deleted(name))
    journal.close()
    return path


def alter(path: Path, *statements: str) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        for statement in statements:
            connection.execute(statement)


def audit(path: Path, *more: str) -> Result:
    return CliRunner().invoke(app, ["access", "audit", "--journal", str(path), *more])


def exported(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in audit(path, "--json").stdout.splitlines()]


def marked(path: Path) -> list[int]:
    return [each["seq"] for each in exported(path) if each["damaged"] is not None]


def why_it_ended(result: Result) -> str:
    assert getattr(result.exception, "exit_code", result.exit_code) == 1
    return str(result.exception)


def test_a_whole_journal_has_no_mark_and_each_line_its_place_in_the_chain(path: Path) -> None:
    assert audit(path).exit_code == 0
    with closing(sqlite3.connect(path)) as connection:
        rows = connection.execute("SELECT written, link FROM batches ORDER BY last").fetchall()
    assert [(each["digest"], each["link"], each["damaged"]) for each in exported(path)] == [
        (written.hex(), link.hex(), None) for written, link in rows
    ]


def test_a_forged_deed_is_marked_and_the_others_are_not(path: Path) -> None:
    alter(path, FORGE.replace("?", "2"))
    told = audit(path)
    lines = told.stdout.splitlines()
    assert [line.split("\t")[4] for line in lines] == [
        "deleted the tree 'one'", "DAMAGED: deleted the tree 'two'",
        "deleted the tree 'three'", "deleted the tree 'four'",
    ]  # fmt: skip
    said = why_it_ended(told)
    assert "the journal is not what was committed" in said
    assert "of those that are listed 1 may not be true" in said
    assert "event 2: not what was committed" in said
    assert marked(path) == [2]
    assert exported(path)[1]["who"] == "anna"


def test_a_forged_deed_with_a_digest_and_a_link_made_anew_is_told_by_the_next_link(
    path: Path,
) -> None:
    alter(path, FORGE.replace("?", "2"))
    with closing(sqlite3.connect(path)) as connection, connection:
        (before,) = connection.execute("SELECT link FROM batches WHERE last = 1").fetchone()
        digest = digest_of(rows_of(connection, 2, 2))
        connection.execute(
            "UPDATE batches SET written = ?, link = ? WHERE last = 2",
            (digest, _linked(before, digest)),
        )
    why_it_ended(audit(path))
    assert 2 in marked(path)


@pytest.mark.parametrize(
    "statements",
    [
        ["DELETE FROM events WHERE seq = 2"],
        ["DELETE FROM events WHERE seq = 2", "DELETE FROM batches WHERE last = 2"],
        ["UPDATE events SET type = 'node_done' WHERE seq = 2"],
    ],
)
def test_a_deed_that_was_taken_out_is_told_though_no_line_is_left_of_it(
    path: Path, statements: list[str]
) -> None:
    alter(path, *statements)
    assert "deeds may be missing" in why_it_ended(audit(path))
    assert [each["seq"] for each in exported(path)] == [1, 3, 4]
    # Also where nothing that is listed is of the damage.
    why_it_ended(audit(path, "--who", "nobody"))


async def test_a_batch_that_cannot_be_read_takes_no_other_deed_with_it(tmp_path: Path) -> None:
    people = People(tmp_path)
    service = build(principals=people.file)
    for name in NAMES:
        await service.journal.append(deleted(name))
    service.journal._write_connection.execute(
        "UPDATE events SET body = CAST(x'ff' AS TEXT) WHERE seq = 2"
    )
    async with service.client(headers=people.headers(Role.ADMIN)) as client:
        deeds = (await client.get("/api/access/deeds")).json()["deeds"]
    service.journal.close()
    told = {each["seq"]: each["damaged"] for each in deeds}
    assert told.pop(2).startswith("the batch of event 2 cannot be read")
    assert told == {1: None, 3: None, 4: None}


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("body", "CAST(x'ff' AS TEXT)"),
        ("body", "CAST(replace(body, 'olga', CAST(x'ff' AS TEXT)) AS TEXT)"),
        ("run", "CAST(x'ff' AS TEXT)"),
    ],
)
def test_a_deed_whose_text_is_none_is_marked_and_takes_no_other_with_it(
    path: Path, column: str, value: str
) -> None:
    alter(path, f"UPDATE events SET {column} = {value} WHERE seq = 2", FORGE.replace("?", "4"))
    said = why_it_ended(audit(path))
    assert "event 2: not what was committed" in said
    assert "event 4: not what was committed" in said
    assert [each["seq"] for each in exported(path)] == [1, 2, 3, 4]
    assert marked(path) == [2, 4]


async def test_nothing_that_is_left_of_a_pruned_journal_is_called_damaged(path: Path) -> None:
    write_history(path, 8)
    with closing(sqlite3.connect(path)) as connection, connection:
        joined(connection)
    journal = SqliteJournal(path)
    await journal.append(deleted("five"))
    journal.close()
    before = exported(path)
    pruned = await prune_file(path, Keep(ended_runs=2), NOW + timedelta(days=1))
    assert len(pruned.runs) == 6
    result = audit(path, "--json")
    assert (result.exit_code, result.exception) == (0, None)
    after = exported(path)
    assert [each for each in after if each["damaged"] is not None] == []
    assert 0 < len(after) < len(before)
    # What is kept of an export is the same as ever, whatever was pruned beside it.
    assert [each for each in after if each not in before] == []


def joined(connection: sqlite3.Connection) -> None:
    """As if everything had been committed by twos of runs: pruning then leaves halves."""
    connection.execute("DELETE FROM batches")
    chain_anew(connection, 31)


def test_an_export_that_was_kept_shows_a_chain_that_was_made_anew(path: Path) -> None:
    kept = exported(path)
    alter(path, FORGE.replace("?", "2"), "DELETE FROM batches")
    with closing(sqlite3.connect(path)) as connection, connection:
        for seq in range(1, 5):
            chain = Chain(connection)
            chain.add(rows_of(connection, seq, seq))
            chain.seal(connection)
    later = exported(path)
    assert marked(path) == []
    assert [each["seq"] for each in kept if each not in later] == [2, 3, 4]
    assert kept[3]["digest"] == later[3]["digest"]
    assert kept[3]["link"] != later[3]["link"]


async def test_damage_is_told_over_rest_too_and_only_the_batches_of_the_page_are_looked_at(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    people = People(tmp_path)
    service = build(principals=people.file)
    for name in NAMES:
        await service.journal.append(deleted(name))
    service.journal._write_connection.execute(FORGE, (3,))
    looked_at: list[tuple[int, int]] = []

    def rows(connection: sqlite3.Connection, first: int, last: int) -> list[Any]:
        looked_at.append((first, last))
        return rows_of(connection, first, last)

    monkeypatch.setattr("mend.server.journal.chain.rows_of", rows)
    async with service.client(headers=people.headers(Role.ADMIN)) as client:
        page = (await client.get("/api/access/deeds?after=1&limit=2")).json()
    service.journal.close()
    assert [(each["seq"], each["damaged"]) for each in page["deeds"]] == [
        (2, None),
        (3, "event 3: not what was committed (something was changed, removed or inserted)"),
    ]
    assert all(len(each["link"]) == len(each["digest"]) == 32 for each in page["deeds"])
    assert looked_at == [(2, 2), (3, 3)]


async def test_what_is_pruned_while_the_batches_are_looked_at_does_not_seem_to_be_missing(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = SqliteJournal(path)

    def rows(connection: sqlite3.Connection, first: int, last: int) -> list[Any]:
        alter(path, "DELETE FROM events WHERE seq = 2")
        return rows_of(connection, first, last)

    monkeypatch.setattr("mend.server.journal.chain.rows_of", rows)
    seals = await journal.seals([2])
    journal.close()
    assert seals[2].wrong is None
