"""`mend report`: what a building's robots did for its people, from a journal."""

from pathlib import Path
from typing import Annotated
from uuid import UUID

import typer

from mend.server.cli.failures import CommandLineError, told_plainly


def report(
    journal: Annotated[Path, typer.Argument(metavar="JOURNAL", help="A journal of a building.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Where to write it, .html.")
    ],
    csv: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Where to write each table as CSV.")
    ] = None,
    site: Annotated[
        UUID | None, typer.Option(help="Whose fleet, where a journal has several.")
    ] = None,
) -> None:
    """Write a report of requests, legs and plans of a site's fleet."""
    from mend.server.journal import events as ev
    from mend.server.journal.reader import JournalReader
    from mend.server.report.fleet_page import write_fleet_csv, write_fleet_report
    from mend.server.report.fleet_questions import TYPES, questions_of
    from mend.server.report.fleet_tally import FleetTally

    types = ("request_changed", "plan_changed", "fleet_told", "leg_begun", "leg_ended")
    with told_plainly():
        with JournalReader(journal) as reader:
            found = list(reader.of_types((*types, *TYPES)))
        events = [each for each in found if isinstance(each, ev.FleetEvent)]
        readable = [each for each in found if isinstance(each, ev.Event)]
        if unreadable := len(found) - len(readable):
            typer.echo(f"{unreadable} events could not be read, and are not counted", err=True)
        sites = sorted({each.site for each in events}, key=str)
        if site is None and len(sites) > 1:
            known = ", ".join(map(str, sites))
            raise CommandLineError(f"'{journal}' has several fleets: say which --site of {known}")
        wanted = site or (sites[0] if sites else None)
        if wanted is None or wanted not in sites:
            of = "" if site is None else f" of site {site}"
            raise CommandLineError(f"'{journal}' has no events of a fleet{of}: nobody asked there")
        tables = FleetTally.of(each for each in events if each.site == wanted).tables()
        tables.insert(2, questions_of(wanted, readable))
        write_fleet_report(output, str(wanted), tables)
        if csv is not None:
            write_fleet_csv(csv, tables)
    typer.echo(output)
