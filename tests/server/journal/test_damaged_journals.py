"""A damaged journal: found by its check and on opening, told in sentences, never in a traceback."""

import asyncio
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress
from datetime import UTC, datetime
from pathlib import Path

import pytest
from checked_journal import checked, truncated
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_up_history import made_up_run, run_id, write_history
from pretend_service import pretend_service
from sampled import sample
from task_documents import definition_of
from typer.testing import CliRunner

from mend.errors import NotFoundError, RefusalError, UnreadableError
from mend.server.cli import app
from mend.server.journal import events as ev
from mend.server.journal.file_lock import JournalLockedError
from mend.server.journal.journal import Entry, JournalReadError
from mend.server.journal.migrations import JournalSchemaError
from mend.server.journal.reader import JournalReader
from mend.server.journal.run_index import RunPage
from mend.server.journal.sqlite import SqliteJournal

RUNS = 6
EVENTS = len(made_up_run())

ONE_PART = definition_of(
    {"then": [{"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"}]}
)

KNOWN = (RefusalError, JournalReadError, JournalSchemaError, JournalLockedError)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A journal of a few runs; copied by every test."""
    path = tmp_path_factory.mktemp("whole") / "journal.db"
    write_history(path, RUNS, pictures=True)
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return path


@pytest.fixture
def journal(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(whole, tmp_path / "journal.db"))


def alter(path: Path, statement: str, *parameters: object) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute(statement, parameters)


def test_a_whole_journal_has_nothing_to_find(journal: Path) -> None:
    check = checked(journal)
    assert check.findings == []
    assert (check.runs, check.events) == (RUNS, RUNS * EVENTS)


async def test_what_belongs_to_no_run_is_no_run_that_has_something_wrong(journal: Path) -> None:
    opened = SqliteJournal(journal)
    deed = ev.DocumentDeleted(
        wall_time=datetime(2026, 1, 1, tzinfo=UTC), kind="tree", name="base", author=None
    )
    await opened.append(Entry(events=[deed]))
    opened.close()
    check = checked(journal)
    assert check.findings == []
    assert (check.runs, check.events) == (RUNS, RUNS * EVENTS + 1)
    alter(journal, "UPDATE events SET body = body || ' ' WHERE run = ?", str(ev.NO_RUN))
    (finding,) = checked(journal).findings
    assert "not what was committed" in finding.sentence
    assert finding.runs == frozenset()


CHANGES: dict[str, str] = {
    "changed": "UPDATE events SET body = replace(body, 'anna', 'bert') WHERE run = ?",
    "removed": "DELETE FROM events WHERE type = 'step_started' AND run = ?",
    "moved": f"UPDATE events SET run = '{run_id(5)}' WHERE type = 'node_done' AND run = ?",
    "told otherwise": "UPDATE events SET time = time + 1 WHERE type = 'answered' AND run = ?",
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_was_done_to_an_event_is_noticed(journal: Path, change: str) -> None:
    alter(journal, CHANGES[change], str(run_id(2)))
    findings = checked(journal).findings
    assert findings
    assert any("not what was committed" in each.sentence for each in findings)
    concerned = {run for each in findings for run in each.runs}
    assert concerned <= {str(run_id(2)), str(run_id(5))}
    assert str(run_id(2)) in concerned


def test_an_inserted_event_is_noticed(journal: Path) -> None:
    alter(
        journal,
        "INSERT INTO events SELECT max(seq) + 1, run, type, time, version, body FROM events",
    )
    assert any("never committed" in each.sentence for each in checked(journal).findings)


@pytest.mark.parametrize("batch", [1, 3])
def test_a_removed_batch_is_noticed(journal: Path, batch: int) -> None:
    last = batch * EVENTS
    alter(journal, "DELETE FROM events WHERE seq BETWEEN ? AND ?", last - EVENTS + 1, last)
    alter(journal, "DELETE FROM batches WHERE last = ?", last)
    sentences = [each.sentence for each in checked(journal).findings]
    assert any("belong to no batch" in each for each in sentences)


def test_a_batch_that_was_made_anew_breaks_the_chain(journal: Path) -> None:
    alter(journal, "UPDATE batches SET written = zeroblob(16) WHERE last = ?", 2 * EVENTS)
    assert any("the chain is broken" in each.sentence for each in checked(journal).findings)


def test_an_event_that_no_model_reads_and_a_run_that_does_not_fold_are_told(journal: Path) -> None:
    alter(
        journal, "UPDATE events SET body = '{}' WHERE type = 'answered' AND run = ?", str(run_id(1))
    )
    alter(
        journal,
        """UPDATE events SET body = replace(body, '"node":"/0"', '"node":"/9"') WHERE run = ?""",
        str(run_id(3)),
    )
    findings = checked(journal).findings
    assert any("cannot be read" in e.sentence and e.runs == {str(run_id(1))} for e in findings)
    assert any(
        "does not fit what came before" in e.sentence and e.runs == {str(run_id(3))}
        for e in findings
    )


def test_an_index_that_says_what_the_events_do_not_is_told(journal: Path) -> None:
    alter(journal, "UPDATE runs SET ended = NULL, status = 'running' WHERE run = ?", str(run_id(0)))
    alter(journal, "DELETE FROM runs WHERE run = ?", str(run_id(1)))
    sentences = [each.sentence for each in checked(journal).findings]
    assert f"the index says of run {run_id(0)} what its events do not" in sentences
    assert f"run {run_id(1)} has events, but is not in the index" in sentences


# --- On opening ---------------------------------------------------------------------------------


async def test_damage_at_the_end_of_the_chain_is_noticed_on_opening(journal: Path) -> None:
    alter(journal, CHANGES["changed"], str(run_id(RUNS - 1)))
    opened = SqliteJournal(journal)
    [damage] = opened.damage
    opened.close()
    assert damage.runs == {str(run_id(RUNS - 1))}


def emptied(path: Path) -> None:
    path.write_bytes(b"")


def a_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def a_text(path: Path) -> None:
    path.write_text("these are notes, and long enough to be mistaken for something else" * 40)


def scrambled(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[4096 : len(content)] = bytes(len(content) - 4096)
    path.write_bytes(content)


def renamed(path: Path) -> None:
    """A table has a name in the schema that is no text."""
    path.write_bytes(
        path.read_bytes().replace(b"tablereceiptsreceipts", b"table\xc1eceipts\xc1eceipts")
    )


@pytest.mark.parametrize("harm", [emptied, truncated, a_folder, a_text, scrambled, renamed])
def test_a_file_that_is_no_journal_any_more_is_told_in_a_sentence(
    journal: Path, harm: Callable[[Path], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    SqliteJournal(journal).close()
    harm(journal)
    with pytest.raises(KNOWN) as refusal:
        SqliteJournal(journal)
    assert "\n" not in str(refusal.value)
    monkeypatch.setenv("MEND_JOURNAL", str(journal))
    outcome = CliRunner().invoke(app, ["journal", "check"])
    assert outcome.exit_code == 1
    assert outcome.output
    assert "Traceback" not in outcome.output


def test_a_journal_that_was_deleted_begins_anew(journal: Path) -> None:
    SqliteJournal(journal).close()
    journal.unlink()
    opened = SqliteJournal(journal)
    assert opened.head == 0
    opened.close()


FLIPS = st.lists(
    st.tuples(st.floats(0, 1, exclude_max=True), st.integers(0, 7)), min_size=1, max_size=20
)


def flipped(whole: Path, folder: Path, flips: list[tuple[float, int]]) -> Path:
    """A copy of a journal with bits flipped; each place is a part of the whole file."""
    path = folder / "journal.db"
    content = bytearray(whole.read_bytes())
    for place, bit in flips:
        content[int(place * len(content))] ^= 1 << bit
    path.write_bytes(content)
    return path


def test_what_sqlite_says_on_several_lines_is_one_sentence(journal: Path) -> None:
    with closing(sqlite3.connect(journal)) as connection, connection:
        connection.execute("PRAGMA writable_schema = ON")
        connection.execute(
            "UPDATE sqlite_master SET sql = 'CREATE TABLE ' || name || ' (\"a\n TEXT)' "
            "WHERE type = 'table'"
        )
    (finding,) = checked(journal).findings
    assert finding.sentence.startswith("the file is not a journal, or nothing of it can be read")
    assert "\n" not in finding.sentence


@settings(max_examples=sample(20, 60), deadline=None, suppress_health_check=list(HealthCheck))
@given(flips=FLIPS)
def test_a_check_of_flipped_bits_ends_in_sentences(
    whole: Path, tmp_path_factory: pytest.TempPathFactory, flips: list[tuple[float, int]]
) -> None:
    path = flipped(whole, tmp_path_factory.mktemp("flipped"), flips)
    for finding in checked(path).findings:
        assert "\n" not in finding.sentence


@settings(max_examples=sample(13, 40), deadline=None, suppress_health_check=list(HealthCheck))
@given(flips=FLIPS)
def test_a_service_on_flipped_bits_starts_or_says_why_not(
    whole: Path, tmp_path_factory: pytest.TempPathFactory, flips: list[tuple[float, int]]
) -> None:
    path = flipped(whole, tmp_path_factory.mktemp("flipped"), flips)

    async def look_at_everything() -> None:
        async with pretend_service(ONE_PART, journal=path) as service:
            await service.runtime.snapshot(None)
            await service.runtime.dialogues.page(None, 100, 0)
            for listed in await service.runtime.runs(RunPage()):
                with suppress(UnreadableError, NotFoundError):
                    await service.runtime.run(listed.id)

    with suppress(*KNOWN):
        asyncio.run(look_at_everything())


def test_a_damaged_file_tells_what_to_do(journal: Path) -> None:
    truncated(journal)
    with pytest.raises(UnreadableError, match=r"'mend journal check' tells more"):
        SqliteJournal(journal)


def test_an_event_that_names_no_run_is_told_by_the_check(journal: Path) -> None:
    content = journal.read_bytes()
    with closing(sqlite3.connect(journal)) as connection, connection:
        connection.execute("PRAGMA writable_schema = ON")
        connection.execute(
            "UPDATE sqlite_schema SET sql = replace(replace(sql, 'run TEXT NOT NULL', 'run TEXT'),"
            " ') STRICT', ')') WHERE name = 'events'"
        )
    alter(journal, "UPDATE events SET run = NULL WHERE seq = 3")
    assert journal.read_bytes() != content
    outcome = CliRunner().invoke(app, ["journal", "check", str(journal)])
    assert outcome.exit_code == 1
    assert outcome.exception is None or isinstance(outcome.exception, SystemExit)
    assert "event 3 is kept as the number, run, type or time of another" in outcome.output


def test_a_run_without_an_id_is_told_to_whoever_reads(journal: Path) -> None:
    alter(journal, "UPDATE events SET run = 'p' || run WHERE type = 'run_started' AND seq < 9")
    with JournalReader(journal) as reader, pytest.raises(JournalReadError, match="no id any more"):
        reader.runs()
