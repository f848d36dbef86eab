"""A service prunes again and again, and lets nothing that fails keep it from that."""

import sqlite3
from collections.abc import Callable
from datetime import UTC, datetime
from uuid import UUID, uuid4

import pytest

from mend.server.journal.journal import JournalClosedError, JournalWriteError
from mend.server.journal.pruning import Keep, Pruned
from mend.server.retention import EVERY_S, prune_regularly

NOW = datetime(2026, 1, 1, tzinfo=UTC)


class PretendJournal:
    """Fails at its second pruning, and is closed at its fourth."""

    def __init__(self, run: UUID, error: Exception | None = None) -> None:
        self.asked: list[tuple[Keep, datetime]] = []
        self._run = run
        self._error = error or JournalWriteError("the disk is full")

    async def prune(self, keep: Keep, now: datetime, forget: Callable[[UUID], None]) -> Pruned:
        self.asked.append((keep, now))
        if len(self.asked) == 2:
            raise self._error
        if len(self.asked) == 4:
            raise JournalClosedError("the journal is closed")
        forget(self._run)
        return Pruned(runs=[self._run])


async def pruned(journal: PretendJournal, keep: Keep) -> tuple[list[UUID], list[float]]:
    """The runs whose poses were forgotten, and the pauses."""
    forgotten: list[UUID] = []
    pauses: list[float] = []

    async def sleep(seconds: float) -> None:
        pauses.append(seconds)

    await prune_regularly(journal.prune, forgotten.append, keep, lambda: NOW, sleep)
    return forgotten, pauses


async def test_it_goes_on_after_a_failure_until_the_journal_is_closed() -> None:
    run = uuid4()
    journal = PretendJournal(run)
    forgotten, pauses = await pruned(journal, Keep(ended_runs=3))
    assert journal.asked == [(Keep(ended_runs=3), NOW)] * 4
    assert forgotten == [run, run]
    assert pauses == [EVERY_S] * 3


@pytest.mark.parametrize(
    "error",
    [
        sqlite3.DatabaseError("database disk image is malformed"),
        AttributeError("'str' object has no attribute 'get'"),
        ValueError("badly formed hexadecimal UUID string"),
    ],
)
async def test_it_goes_on_after_what_nobody_expected_and_tells_the_log(
    error: Exception, caplog: pytest.LogCaptureFixture
) -> None:
    journal = PretendJournal(uuid4(), error)
    forgotten, pauses = await pruned(journal, Keep(ended_runs=3))
    assert len(forgotten) == 2
    assert pauses == [EVERY_S] * 3
    assert str(error) in caplog.text


async def test_where_all_is_kept_nothing_is_ever_pruned() -> None:
    journal = PretendJournal(uuid4())
    assert await pruned(journal, Keep()) == ([], [])
    assert journal.asked == []
