"""Pruning: what is not kept goes with all that belongs to it, and nothing else does."""

import asyncio
import sqlite3
from collections.abc import Callable
from contextlib import closing
from datetime import timedelta
from pathlib import Path
from typing import Any
from uuid import UUID, uuid4

import pytest
from checked_journal import checked
from made_up_history import (
    BEGUN,
    BETWEEN_RUNS,
    JPEG,
    made_up_run,
    picture_id,
    run_id,
    write_history,
)  # fmt: skip
from sample_events import paused, started

from mend.server.journal import events as ev
from mend.server.journal.file_lock import JournalLockedError
from mend.server.journal.journal import Entry, Receipt
from mend.server.journal.offline_pruning import prune_file
from mend.server.journal.pruning import EVENTS_AT_ONCE, Keep
from mend.server.journal.run_index import RunPage
from mend.server.journal.sqlite import SqliteJournal
from mend.server.journal.subscriptions import PrunedEventsError

RUNS = 8
EVENTS = len(made_up_run())
NOW = BEGUN + RUNS * BETWEEN_RUNS


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "journal.db"
    write_history(path, RUNS, pictures=True)
    return path


def size_of(path: Path) -> int:
    return path.stat().st_size


def kept_runs(path: Path) -> list[int]:
    with closing(sqlite3.connect(path)) as connection:
        rows = connection.execute("SELECT run FROM runs ORDER BY begun").fetchall()
    return [UUID(run).node for (run,) in rows]


@pytest.mark.parametrize(
    ("keep", "kept"),
    [
        (Keep(), [0, 1, 2, 3, 4, 5, 6, 7]),
        (Keep(ended_runs=3), [5, 6, 7]),
        (Keep(ended_within=2.5 * BETWEEN_RUNS), [6, 7]),
        (Keep(ended_within=2.5 * BETWEEN_RUNS, ended_runs=1), [7]),
        (Keep(ended_within=timedelta(days=1), ended_runs=6), [2, 3, 4, 5, 6, 7]),
    ],
)
async def test_what_is_kept_stays_and_the_rest_goes_with_all_its_own(
    path: Path, keep: Keep, kept: list[int]
) -> None:
    journal = SqliteJournal(path)
    pruned = await journal.prune(keep, NOW)
    gone = [number for number in range(RUNS) if number not in kept]
    assert [run.node for run in pruned.runs] == gone
    assert (pruned.events, pruned.pictures) == (len(gone) * EVENTS, len(gone))
    assert [each.run.node for each in await journal.index.page(RunPage())] == kept[::-1]
    for number in range(RUNS):
        stays = number in kept
        assert len(await journal.read(0, 1000, run_id(number))) == (EVENTS if stays else 0)
        assert (await journal.picture(picture_id(number)) is not None) == stays
    assert [each.run.node for each in await journal.index.dialogues(None, 100, 0)] == kept
    journal.close()
    assert checked(path).findings == []


async def test_runs_that_have_not_ended_are_kept_with_their_receipts_and_world(
    path: Path,
) -> None:
    journal = SqliteJournal(path)
    run = uuid4()
    await journal.append(
        Entry(
            events=[started(run), paused(run=run)],
            receipt=Receipt("robot", "boot", 1),
            world_run=run,
            world={"clock": 1.0},
        )
    )
    await journal.prune(Keep(ended_within=timedelta(0), ended_runs=1), NOW + timedelta(days=99))
    assert [each.run for each in await journal.index.page(RunPage())] == [run]
    assert await journal.received("robot", "boot") == 1
    assert await journal.world(run) == {"clock": 1.0}
    journal.close()


async def test_receipts_and_the_world_of_a_pruned_run_go(path: Path) -> None:
    journal = SqliteJournal(path)
    mine, other = f"pr2-{0:012x}", f"pr2-{7:012x}"
    await journal.append(Entry(receipt=Receipt(mine, "boot", 9), world_run=run_id(0), world={}))
    await journal.append(Entry(receipt=Receipt(other, "boot", 9), world_run=run_id(7), world={}))
    await journal.prune(Keep(ended_runs=1), NOW)
    assert await journal.received(mine, "boot") == 0
    assert await journal.world(run_id(0)) is None
    assert await journal.received(other, "boot") == 9
    assert await journal.world(run_id(7)) == {}
    journal.close()


async def test_of_a_real_robot_the_receipt_of_the_last_boot_stays(tmp_path: Path) -> None:
    journal = SqliteJournal(tmp_path / "journal.db")
    run = uuid4()
    live = started(run).model_copy(update={"world": "live", "robots": ["arm"]})
    back = [
        ev.RobotBack(time=1.0, wall_time=BEGUN, run=run, robot="arm", boot=boot, continues=False)
        for boot in ("first", "second")
    ]
    end = ev.RunFinished(time=2.0, wall_time=BEGUN, run=run, missing=[])
    await journal.append(Entry(events=[live, *back, end], receipt=Receipt("arm", "first", 3)))
    await journal.append(Entry(receipt=Receipt("arm", "second", 4)))
    await journal.prune(Keep(ended_within=timedelta(days=1)), BEGUN + timedelta(days=9))
    assert await journal.received("arm", "first") == 0
    assert await journal.received("arm", "second") == 4
    journal.close()


@pytest.mark.parametrize(
    ("keep", "left"),
    [
        (Keep(ended_within=timedelta(days=10)), [6, 7, 8, 9]),
        (Keep(ended_runs=1), [3, 4, 5, 6, 7, 8, 9]),
        (Keep(picture_bytes=10**9), [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]),
    ],
)
async def test_of_earlier_starts_that_no_run_names_no_receipt_is_kept_for_ever(
    tmp_path: Path, keep: Keep, left: list[int]
) -> None:
    now = BEGUN
    journal = SqliteJournal(tmp_path / "journal.db", wall_time_s=lambda: now.timestamp())
    for boot in range(10):
        # A robot starts anew every three days; in between a run begins and ends without it.
        await journal.append(Entry(receipt=Receipt("arm", f"boot {boot}", 3)))
        now += timedelta(days=3)
        if boot in (1, 3):
            run = uuid4()
            begin = started(run).model_copy(update={"wall_time": now})
            end = ev.RunFinished(time=2.0, wall_time=now, run=run, missing=[])
            await journal.append(Entry(events=[begin, end]))
    await journal.append(Entry(receipt=Receipt("quiet", "only", 7)))
    await journal.prune(keep, now)
    boots = [each for each in range(10) if await journal.received("arm", f"boot {each}")]
    assert boots == left
    assert await journal.received("quiet", "only") == 7
    journal.close()


async def test_a_robot_that_started_often_keeps_nobody_waiting_while_its_starts_are_forgotten(
    tmp_path: Path,
) -> None:
    async def steps_for(boots: int) -> int:
        """How much SQLite does, in units of 100 of its instructions."""
        journal = SqliteJournal(tmp_path / f"{boots}.db")
        journal._write_connection.executemany(
            "INSERT INTO receipts (robot, boot, seq, time) VALUES ('arm', ?, 1, ?)",
            [(f"boot {boot}", float(boot)) for boot in range(boots)],
        )
        steps = 0

        def count() -> int:
            nonlocal steps
            steps += 1
            return 0

        journal._write_connection.set_progress_handler(count, 100)
        await journal.prune(Keep(ended_within=timedelta(days=1)), NOW)
        left = journal._write_connection.execute("SELECT count(*) FROM receipts").fetchone()
        journal.close()
        assert left == (1,)
        return steps

    assert await steps_for(4000) < 8 * await steps_for(1000)


async def test_numbers_are_never_given_again(path: Path) -> None:
    journal = SqliteJournal(path)
    head = journal.head
    await journal.prune(Keep(ended_within=timedelta(0)), NOW + timedelta(days=9))
    journal.close()
    again = SqliteJournal(path)
    assert again.head == head
    (event,) = await again.append(Entry(events=[paused()]))
    assert event.seq == head + 1
    again.close()
    assert [each.sentence for each in checked(path).findings if "chain" in each.sentence] == []


async def test_what_was_damaged_before_stays_told(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        # Two runs in one batch, of which only one will be kept.
        connection.execute("DELETE FROM batches WHERE last IN (?, ?)", (EVENTS, 2 * EVENTS))
        connection.execute(
            "UPDATE batches SET first = 1, written = zeroblob(16) WHERE last = ?", (3 * EVENTS,)
        )
    journal = SqliteJournal(path)
    await journal.prune(Keep(ended_runs=RUNS - 1), NOW)
    journal.close()
    assert any("were damaged before" in each.sentence for each in checked(path).findings)


async def test_runs_that_share_batches_go_one_by_one(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path)
    runs = [uuid4() for _ in range(4)]
    stamp = {"wall_time": BEGUN}
    for step in range(3):
        events: list[ev.Event] = [
            started(run) if step == 0
            else paused(run=run) if step == 1
            else ev.RunFailed(time=2.0, run=run, reason="so", **stamp)
            for run in runs
        ]  # fmt: skip
        await journal.append(Entry(events=events))
    for left in (3, 2, 1):
        await journal.prune(Keep(ended_runs=left), NOW)
        found = [each for each in checked(path).findings if "committed" in each.sentence]
        assert found == []
        seqs = [each.seq for each in await journal.read(0, 100)]
        assert len(seqs) == 3 * left
    journal.close()


class StoppedError(Exception):
    """The process was killed here."""


async def test_what_a_kill_left_half_pruned_is_done_by_the_next_pruning(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    run = uuid4()
    journal = SqliteJournal(path)
    many = [paused(float(n), run) for n in range(2 * EVENTS_AT_ONCE)]
    end = ev.RunFailed(time=5000.0, wall_time=BEGUN, run=run, reason="so")
    await journal.append(Entry(events=[started(run), *many, end]))
    pieces = 0
    submit = journal._writer.submit

    def dying(work: Callable[[sqlite3.Connection], Any]) -> Any:
        nonlocal pieces
        pieces += 1
        if pieces == 5:
            raise StoppedError
        return submit(work)

    journal._writer.submit = dying  # type: ignore[method-assign]
    keep, now = Keep(ended_within=timedelta(days=1)), BEGUN + timedelta(days=9)
    with pytest.raises(StoppedError):
        await journal.prune(keep, now)
    journal._writer.submit = submit  # type: ignore[method-assign]
    assert await journal.index.find(run) is None
    assert 0 < len(await journal.read(0, 10_000)) < len(many)
    assert checked(path).findings == []
    forgotten: list[UUID] = []
    await journal.prune(keep, now, forgotten.append)
    assert forgotten == [run]
    assert await journal.read(0, 10_000) == []
    assert await journal.pruned_through() == len(many) + 2
    journal.close()
    assert checked(path).findings == []


# --- Pictures -----------------------------------------------------------------------------------


async def test_the_oldest_pictures_go_first_but_none_of_a_run_that_goes_on(
    tmp_path: Path,
) -> None:
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path)
    run = uuid4()
    raised = next(each for each in made_up_run() if isinstance(each, ev.IssueRaised))
    own = uuid4()
    await journal.append(
        Entry(
            events=[started(run), raised.model_copy(update={"run": run, "picture": own})],
            pictures={own: JPEG},
        )
    )
    journal.close()
    write_history(path, RUNS, pictures=True)
    journal = SqliteJournal(path)
    pruned = await journal.prune(Keep(picture_bytes=3 * len(JPEG)), NOW)
    assert (len(pruned.runs), pruned.pictures) == (0, RUNS - 2)
    assert await journal.picture(own) == JPEG
    there = [n for n in range(RUNS) if await journal.picture(picture_id(n)) is not None]
    assert there == [6, 7]
    journal.close()


# --- Whoever follows ----------------------------------------------------------------------------


async def test_a_subscription_from_before_what_was_pruned_gets_a_sentence_not_a_gap(
    path: Path,
) -> None:
    journal = SqliteJournal(path)
    await journal.prune(Keep(ended_runs=2), NOW)
    through = await journal.pruned_through()
    assert through == (RUNS - 2) * EVENTS
    for after in (0, EVENTS, through - 1):
        with (
            journal.subscribe(after) as subscription,
            pytest.raises(PrunedEventsError, match=rf"event {after + 1} was pruned"),
        ):
            await subscription.take()
    with journal.subscribe(through) as subscription:
        records = await subscription.take()
    assert [each.seq for each in records] == list(range(through + 1, journal.head + 1))
    journal.close()


# --- From another process -----------------------------------------------------------------------


async def test_a_journal_is_pruned_while_its_service_writes(path: Path) -> None:
    journal = SqliteJournal(path)
    run = uuid4()

    async def write() -> None:
        for number in range(50):
            await journal.append(Entry(events=[started(run) if number == 0 else paused(run=run)]))

    _, pruned = await asyncio.gather(write(), prune_file(path, Keep(ended_runs=1), NOW))
    assert len(pruned.runs) == RUNS - 1
    assert len(await journal.read(0, 1000, run)) == 50
    journal.close()
    sentences = [each.sentence for each in checked(path).findings]
    assert [each for each in sentences if str(run) not in each] == []
    assert kept_runs(path)[0] == RUNS - 1


async def test_room_is_given_back_only_while_no_service_has_the_journal(path: Path) -> None:
    write_history(path, 200, first=RUNS, pictures=True)
    journal = SqliteJournal(path)
    with pytest.raises(JournalLockedError):
        await prune_file(path, Keep(ended_runs=1), NOW, compact=True)
    assert len(kept_runs(path)) == RUNS + 200
    journal.close()
    before = size_of(path)
    await prune_file(path, Keep(ended_runs=1), NOW, compact=True)
    assert size_of(path) < before / 4
    assert checked(path).findings == []


async def test_a_damaged_id_or_clip_keeps_nothing_else_from_being_pruned(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("UPDATE runs SET run = 'damaged' WHERE run = ?", (str(run_id(0)),))
        for run, clip in ((1, '"nothing"'), (2, '["nothing"]'), (3, "null")):
            body = '{"type": "clip_recorded", "pictures": ' + clip + "}"
            connection.execute(
                "UPDATE events SET type = 'clip_recorded', body = ? WHERE seq ="
                " (SELECT max(seq) - 1 FROM events WHERE run = ?)",
                (body, str(run_id(run))),
            )
    forgotten: list[UUID] = []
    pruned = await prune_file(path, Keep(ended_runs=2), NOW, forgotten.append)
    assert pruned.runs == forgotten == [run_id(run) for run in range(1, 6)]
    assert kept_runs(path) == [6, 7]
