"""Pruning: ended runs that nobody keeps any more leave the journal, in many small transactions."""

import json
import sqlite3
from collections.abc import Awaitable, Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from functools import partial
from typing import Any, Protocol
from uuid import UUID

from mend.server.journal.chain import (
    DAMAGED,
    NOTHING_LEFT,
    Batch,
    batch_of,
    digest_of,
    rows_of,
)
from mend.server.journal.issue_index import forget_issues_of_run
from mend.server.journal.keyed_request import forget_requests_of_run
from mend.server.journal.work_index import forget_work_of_run

EVENTS_AT_ONCE = 500
RUNS_AT_ONCE = 20
PICTURES_AT_ONCE = 200

LIVE = "live"
PICTURE_TYPES = ("issue_raised", "clip_recorded", "cameras_recorded")
BOOT_TYPES = ("node_started", "robot_back")


@dataclass(frozen=True, slots=True)
class Keep:
    """What is kept: runs that ended so lately, the newest so many, so many bytes of pictures.

    None keeps all. Runs that have not ended are always kept, with their pictures.
    """

    ended_within: timedelta | None = None
    ended_runs: int | None = None
    picture_bytes: int | None = None

    @property
    def all(self) -> bool:
        return self == Keep()


@dataclass(slots=True)
class Pruned:
    """What went; `runs` in the order in which they ended."""

    runs: list[UUID] = field(default_factory=list)
    events: int = 0
    pictures: int = 0


class Execute(Protocol):
    """Does a piece of work in a transaction of its own, or with what else is waiting."""

    def __call__(self, work: Callable[[sqlite3.Connection], Any], /) -> Awaitable[Any]: ...


async def prune(
    execute: Execute, keep: Keep, now: datetime, forget: Callable[[UUID], None]
) -> Pruned:
    """Take out of a journal what is not kept.

    A run is first taken from the index, and so from every list; then `forget` has the chance to
    delete what is kept of it elsewhere, and its events go, a few at a time. What a kill left half
    done is done by the next pruning.
    """
    pruned = Pruned()
    runs: list[str] = await execute(_left_by_a_kill)
    while True:
        for run in _ids(runs):
            forget(run)
        while gone := await execute(_delete_some):
            pruned.events += gone.events
            pruned.pictures += gone.pictures
        runs = await execute(lambda connection: _let_go(connection, keep, now))
        if not runs:
            break
        pruned.runs += _ids(runs)
    if keep.ended_within is not None or keep.ended_runs is not None:
        await execute(lambda connection: _forget_boots(connection, keep, now))
    if keep.picture_bytes is not None:
        pruned.pictures += await _prune_pictures(execute, keep.picture_bytes)
    return pruned


def _ids(runs: Iterable[str]) -> list[UUID]:
    """The ids of runs: what is damaged names nothing that would be kept elsewhere."""
    found = []
    for run in runs:
        with suppress(ValueError):
            found.append(UUID(run))
    return found


async def _prune_pictures(execute: Execute, most_bytes: int) -> int:
    """Delete the oldest pictures while there are more bytes; returns how many."""
    size = await execute(_size_of_pictures)
    count = 0
    while size > most_bytes:
        beyond = size - most_bytes
        gone: _Gone = await execute(partial(_delete_pictures, beyond=beyond))
        if not gone.pictures:
            break
        count += gone.pictures
        size -= gone.picture_bytes
    return count


def pruned_through(connection: sqlite3.Connection) -> int:
    """The highest `seq` that was pruned; 0 if none was."""
    return int(connection.execute("SELECT coalesce(max(through), 0) FROM pruned").fetchone()[0])


# --- Runs ---------------------------------------------------------------------------------------


def _let_go(connection: sqlite3.Connection, keep: Keep, now: datetime) -> list[str]:
    """Take a few runs out of the index, with all but their events and pictures."""
    runs = _not_kept(connection, keep, now)
    for run, world, robots in runs:
        connection.execute("INSERT INTO pruning (run) VALUES (?)", (run,))
        connection.execute("DELETE FROM worlds WHERE run = ?", (run,))
        connection.execute("DELETE FROM dialogues WHERE run = ?", (run,))
        forget_issues_of_run(connection, run)
        forget_work_of_run(connection, run)
        forget_requests_of_run(connection, run)
        _delete_receipts(connection, run, world, robots)
        connection.execute("DELETE FROM runs WHERE run = ?", (run,))
    if runs:
        connection.execute("UPDATE pruned SET runs = runs + ?", (len(runs),))
    return [run for run, _, _ in runs]


def _left_by_a_kill(connection: sqlite3.Connection) -> list[str]:
    return [run for (run,) in connection.execute("SELECT run FROM pruning")]


def _not_kept(
    connection: sqlite3.Connection, keep: Keep, now: datetime
) -> list[tuple[str, str, str]]:
    conditions: list[str] = []
    if keep.ended_within is not None:
        conditions.append("ended_at < :since")
    if keep.ended_runs is not None:
        conditions.append(
            "ended <= (SELECT ended FROM runs WHERE ended IS NOT NULL"
            " ORDER BY ended DESC LIMIT 1 OFFSET :most)"
        )
    if not conditions:
        return []
    since = now - (keep.ended_within or timedelta())
    return connection.execute(
        "SELECT run, world, robots FROM runs"
        f" WHERE ended IS NOT NULL AND ({' OR '.join(conditions)}) ORDER BY ended LIMIT :limit",
        {"since": since.timestamp(), "most": keep.ended_runs, "limit": RUNS_AT_ONCE},
    ).fetchall()


def _delete_receipts(connection: sqlite3.Connection, run: str, world: str, robots: str) -> None:
    """A simulated robot is of one run; a real one may still send what its last boot has to say."""
    if world == LIVE:
        for receipt in _earlier_boots(connection, run):
            connection.execute("DELETE FROM receipts WHERE robot = ? AND boot = ?", receipt)
        return
    with suppress(ValueError, TypeError):
        for robot in json.loads(robots):
            connection.execute("DELETE FROM receipts WHERE robot = ?", (str(robot),))


def _earlier_boots(connection: sqlite3.Connection, run: str) -> Iterator[tuple[str, str]]:
    """Every boot of each robot of a run but its last."""
    boots: dict[str, dict[str, None]] = {}
    for event in _read(_bodies(connection, run, BOOT_TYPES)):
        of_robot = boots.setdefault(str(event.get("robot")), {})
        of_robot.pop(str(event.get("boot")), None)
        of_robot[str(event.get("boot"))] = None
    for robot, of_robot in boots.items():
        for boot in list(of_robot)[:-1]:
            yield robot, boot


def _forget_boots(connection: sqlite3.Connection, keep: Keep, now: datetime) -> None:
    """Delete the receipts of earlier starts of robots, also of those that no run names.

    What an earlier start left behind a robot sends before anything of its own: so it is
    enough that a later one was last heard of before what is kept.
    """
    since = None if keep.ended_within is None else (now - keep.ended_within).timestamp()
    connection.execute(
        # Once for each robot: each start compared with each would keep all who write waiting.
        "WITH latest AS (SELECT robot, max(time) AS time FROM receipts"
        " WHERE time < coalesce(:since, (SELECT min(started) FROM runs)) GROUP BY robot)"
        " DELETE FROM receipts WHERE time <"
        " (SELECT time FROM latest WHERE latest.robot = receipts.robot)",
        {"since": since},
    )


def _bodies(connection: sqlite3.Connection, run: str, types: Sequence[str]) -> Iterator[str]:
    rows = connection.execute(
        "SELECT body FROM events WHERE run = ?"
        f" AND type IN ({', '.join('?' * len(types))}) ORDER BY seq",
        (run, *types),
    )
    return (body for (body,) in rows)


def _read(bodies: Iterable[str]) -> Iterator[dict[str, Any]]:
    """The events that can be read: one that cannot names nothing that could go."""
    for body in bodies:
        with suppress(ValueError):
            event = json.loads(body)
            if isinstance(event, dict):
                yield event


# --- Events -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Gone:
    events: int
    pictures: int
    picture_bytes: int = 0


def _delete_some(connection: sqlite3.Connection) -> _Gone | None:
    """Delete some events of a run that was let go; None when there is no such run."""
    row = connection.execute("SELECT run FROM pruning LIMIT 1").fetchone()
    if row is None:
        return None
    (run,) = row
    found = connection.execute(
        "SELECT seq, type, body FROM events WHERE run = ? ORDER BY seq LIMIT ?",
        (run, EVENTS_AT_ONCE),
    ).fetchall()
    if len(found) < EVENTS_AT_ONCE:
        connection.execute("DELETE FROM pruning WHERE run = ?", (run,))
    if not found:
        return _Gone(0, 0)
    _unchain(connection, [seq for seq, _, _ in found])
    pictures = _pictures(body for _, kind, body in found if kind in PICTURE_TYPES)
    for picture in pictures:
        connection.execute("DELETE FROM pictures WHERE id = ?", (picture,))
    connection.execute("UPDATE pruned SET through = max(through, ?)", (found[-1][0],))
    return _Gone(len(found), len(pictures))


def _pictures(bodies: Iterable[str]) -> list[str]:
    """The pictures that events name: of an issue, of a clip, and of a film."""
    named = []
    for event in _read(bodies):
        named.append(event.get("picture"))
        clip = event.get("pictures")
        named += [
            each.get("picture")
            for each in (clip if isinstance(clip, list) else ())
            if isinstance(each, dict)
        ]
    return [each for each in named if isinstance(each, str)]


def _unchain(connection: sqlite3.Connection, seqs: Sequence[int]) -> None:
    """Delete events, and keep the digests of what is left of their batches."""
    going = set(seqs)
    at = 0
    while at < len(seqs):
        batch = batch_of(connection, seqs[at])
        last = seqs[at] if batch is None else batch.last
        if batch is not None:
            _keep_digest(connection, batch, going)
        while at < len(seqs) and seqs[at] <= last:
            at += 1
    connection.executemany("DELETE FROM events WHERE seq = ?", [(seq,) for seq in seqs])


def _keep_digest(connection: sqlite3.Connection, batch: Batch, going: set[int]) -> None:
    rows = rows_of(connection, batch.first, batch.last)
    left = [row for row in rows if row[0] not in going]
    # Damage must not vanish by pruning what is beside it, unless nothing at all is left.
    whole = not left or digest_of(rows) == batch.expected
    kept = digest_of(left) if whole else DAMAGED
    connection.execute("UPDATE batches SET kept = ? WHERE last = ?", (kept, batch.last))
    if not left:
        _join(connection, batch)


def _join(connection: sqlite3.Connection, batch: Batch) -> None:
    """Join a batch of which nothing is left with its neighbours of which nothing is either."""
    first, last = batch.first, batch.last
    before = batch_of(connection, batch.first - 1)
    after = batch_of(connection, batch.last + 1)
    if before is not None and before.kept == NOTHING_LEFT:
        connection.execute("DELETE FROM batches WHERE last = ?", (before.last,))
        first = before.first
    if after is not None and after.kept == NOTHING_LEFT:
        connection.execute("DELETE FROM batches WHERE last = ?", (batch.last,))
        last = after.last
    if (first, last) != (batch.first, batch.last):
        connection.execute(
            "UPDATE batches SET first = ?, written = NULL WHERE last = ?", (first, last)
        )


# --- Pictures -----------------------------------------------------------------------------------


def _size_of_pictures(connection: sqlite3.Connection) -> int:
    return int(connection.execute("SELECT total(length(jpeg)) FROM pictures").fetchone()[0])


def _delete_pictures(connection: sqlite3.Connection, beyond: int) -> _Gone:
    """Delete a few of the oldest pictures of ended runs, of at least so many bytes if it can."""
    needed = _pictures_of_runs_that_go_on(connection)
    going: list[tuple[str]] = []
    freed = 0
    for picture, length in connection.execute(
        "SELECT id, length(jpeg) FROM pictures ORDER BY rowid"
    ):
        if freed >= beyond or len(going) >= PICTURES_AT_ONCE:
            break
        if picture not in needed:
            going.append((picture,))
            freed += length
    connection.executemany("DELETE FROM pictures WHERE id = ?", going)
    return _Gone(0, len(going), freed)


def _pictures_of_runs_that_go_on(connection: sqlite3.Connection) -> set[str]:
    runs = connection.execute("SELECT run FROM runs WHERE ended IS NULL").fetchall()
    return {
        picture for (run,) in runs for picture in _pictures(_bodies(connection, run, PICTURE_TYPES))
    }
