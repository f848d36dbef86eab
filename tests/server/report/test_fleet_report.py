"""`mend report` counts what a journal tells of a building's fleet, and nothing else."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from uuid import UUID

import pytest

from mend.server.cli.failures import CommandLineError
from mend.server.cli.report import report
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal

COMMON: dict[str, Any] = {"wall_time": datetime(2026, 1, 2, tzinfo=UTC), "site": UUID(int=9)}
LEG: dict[str, Any] = {"robot": "r0", "number": 1, "booking": "tea", "action": "visit"}


def asked(status: str, at_s: float) -> ev.RequestChanged:
    what = {"kind": "go_to_room", "name": "tea"}
    more: dict[str, Any] = {"reason": None, "robot": None, "done_s": None}
    return ev.RequestChanged(at_s=at_s, request="tea", what=what, status=status, **more, **COMMON)


DAY = [
    asked("booked", 0.0),
    ev.LegBegun(at_s=30.0, place="F2/201", start="F1/101", **LEG, **COMMON),
    ev.LegEnded(
        at_s=90.0, place="F2/201", at="F2/201", outcome="done", reason=None, **LEG, **COMMON
    ),
    asked("done", 120.0),
]


async def journal_of(path: Path, events: list[Any]) -> Path:
    journal = SqliteJournal(str(path))
    if events:
        await journal.append(Entry(events=events))
    journal.close()
    return path


async def test_requests_and_busy_time_are_counted(tmp_path: Path) -> None:
    path = await journal_of(tmp_path / "day.sqlite", DAY)
    report(path, tmp_path / "day.html", csv=tmp_path / "csv")
    kinds = (tmp_path / "csv" / "requests.csv").read_text(encoding="utf-8").splitlines()
    assert kinds[1] == "go to room,1,0,1,1,0,0"
    robots = (tmp_path / "csv" / "robots.csv").read_text(encoding="utf-8").splitlines()
    assert robots[1] == "r0,1,1,1,50"
    assert "go to room" in (tmp_path / "day.html").read_text(encoding="utf-8")


async def test_a_span_tells_only_of_what_was_in_it(tmp_path: Path) -> None:
    path = await journal_of(tmp_path / "day.sqlite", DAY)
    report(path, tmp_path / "day.html", csv=tmp_path / "csv", begin="100", until="200")
    assert (tmp_path / "csv" / "requests.csv").read_text(encoding="utf-8").count("\n") == 1
    with pytest.raises(CommandLineError, match="no events of this fleet in that time"):
        report(path, tmp_path / "day.html", begin="2027-01-01")


async def test_a_journal_without_a_fleet_gets_a_sentence(tmp_path: Path) -> None:
    path = await journal_of(tmp_path / "none.sqlite", [])
    with pytest.raises(CommandLineError, match="has no events of a fleet"):
        report(path, tmp_path / "none.html")
