"""`mend replay`: a run told again from its journal."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from uuid import UUID

import typer

from mend.server.cli.failures import CommandLineError, told_plainly

if TYPE_CHECKING:
    from mend.server.cli.output import EventOutput

MAX_LISTED = 5


def replay(
    run: Annotated[
        str, typer.Argument(metavar="RUN", help="The run's id, or enough of its beginning.")
    ],
    journal: Annotated[
        Path | None,
        typer.Option(help="The journal that has the run; without it, all known ones are searched."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print every event as a JSON line.")] = False,
    report: Annotated[
        Path | None, typer.Option(help="Write a report of the run to this HTML file.")
    ] = None,
) -> None:
    """Print the transcript of a run that a journal holds, and write its report."""
    from mend.server.cli.journals import known_journals
    from mend.server.cli.output import JsonLines, LiveTranscript
    from mend.server.cli.reports import write_run_report
    from mend.server.journal.reader import JournalReader

    with told_plainly():
        found = _find([journal] if journal else known_journals(), run, exact=journal is not None)
        output: EventOutput = JsonLines() if json else LiveTranscript()
        with JournalReader(found.journal) as reader:
            events = reader.events(found.run)
            for event in events:
                output.show(event)
            output.close()
            if report is not None:
                write_run_report(report, events, reader)
                output.note(f"report: {report}")


@dataclass(frozen=True, slots=True)
class _Found:
    journal: Path
    run: UUID


def _find(journals: Sequence[Path], prefix: str, *, exact: bool) -> _Found:
    """The one run whose id begins with the prefix. Raises `CommandLineError` otherwise."""
    wanted = prefix.lower().replace("-", "")
    found = [
        _Found(journal, run)
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
