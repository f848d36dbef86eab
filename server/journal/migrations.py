"""The journal's tables: one migration per schema version, applied in order, never edited."""

import sqlite3
from datetime import UTC, datetime

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

MIGRATIONS = (VERSION_1, VERSION_2)


class JournalSchemaError(Exception):
    """The file is no journal, or one that this version of Mend cannot read."""


def migrate(connection: sqlite3.Connection) -> None:
    """Bring a journal's tables to the newest version, one transaction per version.

    Raises `JournalSchemaError` for a journal from a newer Mend or a file that is none, and
    `sqlite3.OperationalError` where the file cannot be read or written.
    """
    try:
        version = _schema_version(connection)
    except sqlite3.OperationalError:
        raise
    except sqlite3.DatabaseError as error:
        raise JournalSchemaError(f"the file is not a journal ({error})") from error
    if version > len(MIGRATIONS):
        raise JournalSchemaError(
            f"the journal has schema version {version}, this Mend knows up to {len(MIGRATIONS)}: "
            "use the newer Mend that wrote it"
        )
    for number in range(version + 1, len(MIGRATIONS) + 1):
        applied = datetime.now(UTC).isoformat()
        connection.executescript(
            f"BEGIN IMMEDIATE; {MIGRATIONS[number - 1]}"
            f"INSERT INTO schema_version (version, applied) VALUES ({number}, '{applied}');"
            "COMMIT;"
        )


def _schema_version(connection: sqlite3.Connection) -> int:
    connection.execute(
        "CREATE TABLE IF NOT EXISTS schema_version"
        " (version INTEGER PRIMARY KEY, applied TEXT NOT NULL) STRICT"
    )
    (version,) = connection.execute("SELECT max(version) FROM schema_version").fetchone()
    return int(version or 0)
