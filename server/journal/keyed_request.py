"""Requests that came under an idempotency key, kept with what came of them.

The row of a request is written in the transaction of the first event that came of it: whatever
kills the service, either both are there or neither is.
"""

import json
import sqlite3
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from uuid import UUID

from pydantic import Field

from mend.server.journal.events import Author, Event


@dataclass(frozen=True, slots=True)
class KeyedRequest:
    """Whose request it is, the key that it came under, and a digest of all that it said."""

    principal: str
    key: str
    digest: bytes


@dataclass(frozen=True, slots=True)
class FirstAnswer:
    """What a request was answered when it was first made; `headers` in their order."""

    status: int
    headers: Sequence[tuple[str, str]]
    body: bytes


@dataclass(frozen=True, slots=True)
class KeptRequest:
    """A request that was made before: the last event that came of it, and its answer.

    `answer` is None where the service ended before it was known, or where it is too long to keep.
    """

    digest: bytes
    seq: int
    answer: FirstAnswer | None


class KeyedAuthor(Author):
    """An author who asks under a key. Events name the author alone; the key is kept beside them."""

    request: KeyedRequest = Field(exclude=True)


def note_request(connection: sqlite3.Connection, events: Iterable[Event]) -> None:
    """Keep under which key the events were asked for, in their transaction."""
    for event in events:
        author = getattr(event, "author", None)
        if isinstance(author, KeyedAuthor):
            request = author.request
            connection.execute(
                "INSERT OR REPLACE INTO requests (principal, key, digest, seq, run, time)"
                " VALUES (?, ?, ?, ?, ?, ?)",
                (
                    request.principal, request.key, request.digest, event.seq, str(event.run),
                    event.wall_time.timestamp(),
                ),
            )  # fmt: skip


def keep_answer(connection: sqlite3.Connection, request: KeyedRequest, answer: FirstAnswer) -> bool:
    """Add the answer of a request; False if nothing of that request is in the journal."""
    done = connection.execute(
        "UPDATE requests SET status = ?, headers = ?, body = ? WHERE principal = ? AND key = ?",
        (
            answer.status, json.dumps(answer.headers), answer.body, request.principal, request.key,
        ),
    )  # fmt: skip
    return done.rowcount > 0


def find_request(
    connection: sqlite3.Connection, principal: str, key: str, since: float
) -> KeptRequest | None:
    """The request that somebody made under a key, if that was after `since` (seconds of 1970)."""
    row = connection.execute(
        "SELECT digest, seq, status, headers, body FROM requests"
        " WHERE principal = ? AND key = ? AND time >= ?",
        (principal, key, since),
    ).fetchone()
    if row is None:
        return None
    digest, seq, status, headers, body = row
    if status is None:
        return KeptRequest(digest, seq, None)
    pairs = [(str(name), str(value)) for name, value in json.loads(headers)]
    return KeptRequest(digest, seq, FirstAnswer(status, pairs, body))


def forget_requests(connection: sqlite3.Connection, principal: str, most: int, since: float) -> int:
    """Delete what is older than `since`, and of somebody all but the latest.

    Returns how many of theirs went for being too many.
    """
    connection.execute("DELETE FROM requests WHERE time < ?", (since,))
    return connection.execute(
        "DELETE FROM requests WHERE principal = ? AND key IN"
        " (SELECT key FROM requests WHERE principal = ? ORDER BY time DESC, seq DESC"
        " LIMIT -1 OFFSET ?)",
        (principal, principal, most),
    ).rowcount


def forget_requests_of_run(connection: sqlite3.Connection, run: str | UUID) -> None:
    """Delete the requests of a run that is pruned."""
    connection.execute("DELETE FROM requests WHERE run = ?", (str(run),))
