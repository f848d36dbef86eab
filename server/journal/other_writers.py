"""Noticing that somebody else puts events into a journal while a service has it."""

import sqlite3

from mend.errors import MendError


class OtherWriters:
    """Whoever writes through another connection than this one."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection
        self._version = self._data_version()

    def refuse(self, next_seq: int) -> None:
        """Raise `MendError` if they have written this event, or later ones.

        Within the transaction in which it is to be written: there they cannot come in between.
        """
        version = self._data_version()
        if version == self._version:
            return
        # Others may well write, as who prunes it: only events have one place to go.
        if self._connection.execute(
            "SELECT 1 FROM events WHERE seq >= ? LIMIT 1", (next_seq,)
        ).fetchone():
            raise MendError(
                "another program writes to this journal: stop that one, and start the service again"
            )
        self._version = version

    def _data_version(self) -> int:
        """A number that changes with whatever is committed through other connections."""
        (version,) = self._connection.execute("PRAGMA data_version").fetchone()
        return int(version)
