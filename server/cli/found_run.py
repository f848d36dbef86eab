"""The run that somebody names on the command line, and the journal that has it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from uuid import UUID

from mend.server.cli.failures import CommandLineError

MAX_LISTED = 5


@dataclass(frozen=True, slots=True)
class FoundRun:
    """A run, and the journal that has it."""

    journal: Path
    run: UUID


def find_run(journals: Sequence[Path], prefix: str, *, exact: bool) -> FoundRun:
    """The one run whose id begins with the prefix. Raises `CommandLineError` otherwise."""
    wanted = prefix.lower().replace("-", "")
    found = [
        FoundRun(journal, run)
        for journal in journals
        for run in _runs_of(journal, exact=exact)
        if run.hex.startswith(wanted)
    ]
    if len(found) == 1 and wanted:
        return found[0]
    if not found or not wanted:
        where = ", ".join(f"'{each}'" for each in journals) if exact else "any known journal"
        raise CommandLineError(f"there is no run '{prefix}' in {where}")
    raise CommandLineError(
        f"'{prefix}' may be any of {_listed(each.run for each in found)}: say more of it"
    )


def _runs_of(journal: Path, *, exact: bool) -> list[UUID]:
    """The runs of a journal; a file that is none counts only if it was asked for."""
    from mend.server.journal.migrations import JournalSchemaError
    from mend.server.journal.reader import JournalReader

    try:
        with JournalReader(journal) as reader:
            return reader.runs()
    except JournalSchemaError:
        if exact:
            raise
        return []


def _listed(runs: Iterable[UUID]) -> str:
    ids = [str(each) for each in runs]
    more = f" and {len(ids) - MAX_LISTED} more" if len(ids) > MAX_LISTED else ""
    return ", ".join(ids[:MAX_LISTED]) + more
