"""`mend replay`: a run told again from its journal."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.failures import told_plainly

if TYPE_CHECKING:
    from mend.server.cli.output import EventOutput


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
    from mend.server.cli.found_run import find_run
    from mend.server.cli.journals import known_journals
    from mend.server.cli.output import JsonLines, LiveTranscript
    from mend.server.cli.reports import write_run_report
    from mend.server.journal.reader import JournalReader

    with told_plainly():
        found = find_run([journal] if journal else known_journals(), run, exact=journal is not None)
        output: EventOutput = JsonLines() if json else LiveTranscript()
        with JournalReader(found.journal) as reader:
            events = reader.events(found.run)
            for event in events:
                output.show(event)
            output.close()
            if report is not None:
                write_run_report(report, events, reader)
                output.note(f"report: {report}")
