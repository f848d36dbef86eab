"""Writing a run's report with the pictures that its journal has."""

from collections.abc import Sequence
from pathlib import Path

from mend.server.journal.events import Event, IssueRaised
from mend.server.journal.reader import JournalReader
from mend.server.report.page import write_report


def write_run_report(path: Path, events: Sequence[Event], journal: JournalReader) -> None:
    """Write the report of a run's events. Raises `OSError` when the file cannot be written."""
    wanted = [each.picture for each in events if isinstance(each, IssueRaised) and each.picture]
    write_report(path, events, journal.pictures(wanted))
