"""The outbox: a robot's reports, kept in SQLite until the service has acknowledged them."""

import sqlite3
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mend.errors import UnavailableError
from mend.robots.link.messages import Driven, Report, ReportBody

IN_MEMORY = ":memory:"

SCHEMA = """
CREATE TABLE IF NOT EXISTS reports (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    robot TEXT NOT NULL,
    boot TEXT NOT NULL,
    seq INTEGER NOT NULL,
    text TEXT NOT NULL,
    UNIQUE (robot, boot, seq)
)
"""


@dataclass(frozen=True, slots=True)
class Stored:
    """An undelivered report; `id` orders all reports of all boots as they were made."""

    id: int
    text: str


class Outbox:
    """The reports of one robot, by (robot, boot, seq).

    `boot` names this start of the robot's program. A file survives the program (`kill -9`) and,
    as every report is synced, a loss of power; the reports that earlier boots left come first.
    In memory is for simulated robots: when they die their world is rebuilt from the journal, and
    what they had not delivered never happened.

    At most `capacity` reports are kept; a robot without a connection finishes what it was told to
    do and then waits, which takes dozens. Raises `UnavailableError` if the file cannot be used or
    another program has it open.
    """

    def __init__(self, path: Path | str, robot: str, boot: str, *, capacity: int = 10_000) -> None:
        self.robot = robot
        self.boot = boot
        self.capacity = capacity
        try:
            self._database = _open(str(path))
        except sqlite3.Error as error:
            raise UnavailableError(f"the outbox '{path}' cannot be used: {error}") from error
        self._count = self._number("SELECT count(*) FROM reports WHERE robot = ?", robot)
        self._last_seq = self._number(
            "SELECT ifnull(max(seq), 0) FROM reports WHERE robot = ? AND boot = ?", robot, boot
        )

    def __len__(self) -> int:
        """How many reports are not acknowledged yet."""
        return self._count

    @property
    def crowded(self) -> bool:
        """Half full: the robot should wait until there is room again."""
        return self._count >= self.capacity // 2

    def add(
        self,
        body: ReportBody,
        time: float,
        world: dict[str, Any] | None,
        driven: Driven | None = None,
    ) -> Report:
        """Keep a new report of this boot. Raises `UnavailableError`."""
        if self._count >= self.capacity:
            raise UnavailableError(
                f"the outbox of '{self.robot}' is full: {self.capacity} reports are undelivered"
            )
        seq = self._last_seq + 1
        report = Report(boot=self.boot, seq=seq, time=time, body=body, world=world, driven=driven)
        self._database.execute(
            "INSERT INTO reports (robot, boot, seq, text) VALUES (?, ?, ?, ?)",
            (self.robot, self.boot, seq, report.model_dump_json(exclude_none=True)),
        )
        self._last_seq = seq
        self._count += 1
        return report

    def after(self, last_id: int, limit: int) -> list[Stored]:
        """Up to `limit` undelivered reports made after the one with `last_id`, oldest first."""
        rows = self._database.execute(
            "SELECT id, text FROM reports WHERE robot = ? AND id > ? ORDER BY id LIMIT ?",
            (self.robot, last_id, limit),
        )
        return [Stored(*row) for row in rows]

    def acknowledge(self, boot: str, seq: int) -> int:
        """Forget a boot's reports up to `seq`; returns how many there were."""
        deleted = self._database.execute(
            "DELETE FROM reports WHERE robot = ? AND boot = ? AND seq <= ?", (self.robot, boot, seq)
        ).rowcount
        if boot == self.boot:
            self._last_seq = max(self._last_seq, seq)
        self._count -= deleted
        return deleted

    def close(self) -> None:
        self._database.close()

    def _number(self, query: str, *parameters: str) -> int:
        (number,) = self._database.execute(query, parameters).fetchone()
        return int(number)


def _open(path: str) -> sqlite3.Connection:
    database = sqlite3.connect(path, timeout=0.0, isolation_level=None, check_same_thread=False)
    try:
        # Two programs that both are this robot must not deliver each other's reports.
        database.execute("PRAGMA locking_mode=EXCLUSIVE")
        database.execute("PRAGMA journal_mode=WAL")
        database.execute("PRAGMA synchronous=FULL")
        database.execute(SCHEMA)
    except BaseException:
        database.close()
        raise
    return database
