"""The journal's tables: one migration per schema version, applied in order, never edited."""

import sqlite3
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from mend.errors import MendError
from mend.server.journal.indexing import index_events, index_issues, index_work

VERSION_1 = """
CREATE TABLE events (
    seq INTEGER PRIMARY KEY,
    run TEXT NOT NULL,
    type TEXT NOT NULL,
    time REAL NOT NULL,
    version INTEGER NOT NULL,
    body TEXT NOT NULL
) STRICT;
CREATE INDEX events_of_run ON events (run, seq);
CREATE INDEX run_starts ON events (seq, run) WHERE type = 'run_started';
CREATE TABLE receipts (
    robot TEXT NOT NULL,
    boot TEXT NOT NULL,
    seq INTEGER NOT NULL,
    PRIMARY KEY (robot, boot)
) STRICT, WITHOUT ROWID;
CREATE TABLE worlds (run TEXT PRIMARY KEY, state TEXT NOT NULL) STRICT;
CREATE TABLE pictures (id TEXT PRIMARY KEY, jpeg BLOB NOT NULL) STRICT;
CREATE TABLE trees (name TEXT PRIMARY KEY, text TEXT NOT NULL) STRICT;
"""

VERSION_2 = """
CREATE TABLE documents (
    kind TEXT NOT NULL,
    name TEXT NOT NULL,
    text TEXT NOT NULL,
    PRIMARY KEY (kind, name)
) STRICT;
INSERT INTO documents (kind, name, text) SELECT 'tree', name, text FROM trees;
DROP TABLE trees;
"""

VERSION_3 = """
CREATE TABLE runs (
    run TEXT PRIMARY KEY,
    begun INTEGER NOT NULL,
    ended INTEGER,
    status TEXT NOT NULL,
    time REAL NOT NULL,
    started REAL NOT NULL,
    ended_at REAL,
    tree TEXT NOT NULL,
    world TEXT NOT NULL,
    scenario TEXT,
    seed INTEGER NOT NULL,
    speed TEXT NOT NULL,
    robots TEXT NOT NULL,
    ending TEXT,
    why TEXT
) STRICT;
CREATE INDEX runs_in_order ON runs (begun);
CREATE INDEX runs_by_status ON runs (status, begun);
CREATE INDEX runs_by_end ON runs (ended, begun);
CREATE TABLE dialogues (
    dialogue TEXT PRIMARY KEY,
    run TEXT NOT NULL,
    opened INTEGER NOT NULL,
    closed INTEGER
) STRICT;
CREATE INDEX dialogues_in_order ON dialogues (opened);
CREATE INDEX dialogues_of_run ON dialogues (run);
CREATE TABLE batches (
    last INTEGER PRIMARY KEY,
    first INTEGER NOT NULL,
    written BLOB,
    kept BLOB,
    link BLOB NOT NULL
) STRICT;
CREATE TABLE pruning (run TEXT PRIMARY KEY) STRICT;
CREATE TABLE pruned (
    only INTEGER PRIMARY KEY CHECK (only = 1),
    through INTEGER NOT NULL,
    runs INTEGER NOT NULL
) STRICT;
INSERT INTO pruned (only, through, runs) VALUES (1, 0, 0);
"""

VERSION_4 = """
CREATE TABLE requests (
    principal TEXT NOT NULL,
    key TEXT NOT NULL,
    digest BLOB NOT NULL,
    seq INTEGER NOT NULL,
    run TEXT NOT NULL,
    time REAL NOT NULL,
    status INTEGER,
    headers TEXT,
    body BLOB,
    PRIMARY KEY (principal, key)
) STRICT;
CREATE INDEX requests_in_order ON requests (time);
CREATE INDEX requests_of_run ON requests (run);
"""

VERSION_5 = """
ALTER TABLE receipts ADD COLUMN time REAL NOT NULL DEFAULT 0.0;
"""


VERSION_6 = """
CREATE TABLE issues (
    seq INTEGER PRIMARY KEY,
    run TEXT NOT NULL,
    issue TEXT NOT NULL,
    object TEXT,
    place TEXT,
    robot TEXT NOT NULL,
    name TEXT NOT NULL,
    node TEXT NOT NULL,
    step INTEGER NOT NULL,
    time REAL NOT NULL,
    raised REAL NOT NULL,
    picture TEXT,
    dialogue TEXT,
    outcome TEXT
) STRICT;
CREATE INDEX issues_of_run ON issues (run, seq);
CREATE INDEX issues_of_kind ON issues (issue, seq);
CREATE INDEX issues_of_object ON issues (object, seq);
"""


VERSION_7 = """
CREATE TABLE picks (
    run TEXT NOT NULL,
    robot TEXT NOT NULL,
    part TEXT NOT NULL,
    picks INTEGER NOT NULL,
    PRIMARY KEY (run, robot, part)
) STRICT, WITHOUT ROWID;
CREATE TABLE questions (
    prompt TEXT PRIMARY KEY,
    run TEXT NOT NULL,
    robot TEXT NOT NULL,
    issue TEXT NOT NULL,
    part TEXT NOT NULL,
    asked REAL NOT NULL,
    answer_s REAL
) STRICT, WITHOUT ROWID;
CREATE INDEX questions_of_run ON questions (run);
CREATE INDEX runs_by_start ON runs (started);
"""


@dataclass(frozen=True, slots=True)
class Migration:
    """What leads to a version: statements, then what cannot be said in SQL."""

    statements: str
    then: Callable[[sqlite3.Connection], None] | None = None


WITH_CHAIN = 3
"""The first schema version that has an index and a chain."""

MIGRATIONS = (
    Migration(VERSION_1),
    Migration(VERSION_2),
    Migration(VERSION_3, index_events),
    Migration(VERSION_4),
    Migration(VERSION_5),
    Migration(VERSION_6, index_issues),
    Migration(VERSION_7, index_work),
)


class JournalSchemaError(MendError):
    """The file is no journal, or one that this version of Mend cannot read."""


def migrate(connection: sqlite3.Connection) -> None:
    """Bring a journal's tables to the newest version, one transaction per version.

    A new journal gets all in one: each waits several times for the disk.

    Raises `JournalSchemaError` for a journal from a newer Mend or a file that is none, and
    `sqlite3.OperationalError` where the file cannot be read or written, another
    `sqlite3.DatabaseError` where it is damaged.
    """
    try:
        version = _schema_version(connection)
    except sqlite3.DatabaseError as error:
        if error.sqlite_errorcode != sqlite3.SQLITE_NOTADB:
            raise
        raise JournalSchemaError(f"the file is not a journal ({error})") from error
    if version > len(MIGRATIONS):
        raise JournalSchemaError(
            f"the journal has schema version {version}, this Mend knows up to {len(MIGRATIONS)}: "
            "use the newer Mend that wrote it"
        )
    missing = range(version + 1, len(MIGRATIONS) + 1)
    for numbers in [missing] if version == 0 else [[number] for number in missing]:
        _apply(connection, numbers)


def _apply(connection: sqlite3.Connection, numbers: Sequence[int]) -> None:
    """Apply the migrations of these numbers, or none of them."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        for number in numbers:
            _apply_one(connection, number, MIGRATIONS[number - 1])
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


def _apply_one(connection: sqlite3.Connection, number: int, migration: Migration) -> None:
    # Not as a script, which would end the transaction.
    for statement in _each_of(migration.statements):
        connection.execute(statement)
    if migration.then is not None:
        migration.then(connection)
    applied = datetime.now(UTC).isoformat()
    connection.execute(
        "INSERT INTO schema_version (version, applied) VALUES (?, ?)", (number, applied)
    )


def _each_of(statements: str) -> Iterator[str]:
    """The statements one by one; each ends its line."""
    statement = ""
    for line in statements.strip().splitlines():
        statement += f"{line}\n"
        if sqlite3.complete_statement(statement):
            yield statement
            statement = ""


def _schema_version(connection: sqlite3.Connection) -> int:
    connection.execute(
        "CREATE TABLE IF NOT EXISTS schema_version"
        " (version INTEGER PRIMARY KEY, applied TEXT NOT NULL) STRICT"
    )
    (version,) = connection.execute("SELECT max(version) FROM schema_version").fetchone()
    return int(version or 0)
