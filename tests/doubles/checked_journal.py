"""Checking a journal as `mend journal check` does, and harming one."""

from collections.abc import Iterable
from pathlib import Path
from uuid import UUID

from mend.dialogue.registry import load_scripts
from mend.server.journal.events import Event
from mend.server.journal.full_check import JournalCheck, check_journal
from mend.server.runtime.history import fold_event

SCRIPTS = load_scripts()


def checked(path: Path) -> JournalCheck:
    """What is wrong with a journal."""
    return check_journal(path, _fold)


def _fold(run: UUID, events: Iterable[Event]) -> None:
    state = None
    for event in events:
        state = fold_event(run, state, event, SCRIPTS)


def truncated(path: Path) -> None:
    """Cut off the second half of a file, and not at a page."""
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2 + 100])
