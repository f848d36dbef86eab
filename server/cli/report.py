"""`mend report`: what a building's robots did for its people, from a journal."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from uuid import UUID

import typer

from mend.server.cli.failures import CommandLineError, told_plainly

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mend.server.journal import events as ev
    from mend.server.report.span import Span


def report(
    journal: Annotated[Path, typer.Argument(metavar="JOURNAL", help="A journal of a building.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Where to write it, .html.")
    ],
    csv: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Where to write each table as CSV.")
    ] = None,
    begin: Annotated[
        str | None,
        typer.Option(
            "--from",
            metavar="TIME",
            help="From when on, as 2026-11-28T09:00 (this machine's time, unless it names a zone), "
            "or in seconds of the site's clock.",
        ),
    ] = None,
    until: Annotated[
        str | None, typer.Option(metavar="TIME", help="Until when, in either way; not included.")
    ] = None,
    site: Annotated[
        UUID | None, typer.Option(help="Whose fleet, where a journal has several.")
    ] = None,
) -> None:
    """Write a report of requests, legs and plans of a site's fleet."""
    from mend.server.report.span import Span

    with told_plainly():
        write_report(journal, output, csv=csv, span=Span.read(begin, until), site=site)
    typer.echo(output)


def write_report(
    journal: Path,
    output: Path,
    *,
    csv: Path | None = None,
    span: "Span | None" = None,
    site: UUID | None = None,
) -> None:
    """Write the page, and its tables to a folder. Raises `CommandLineError` where there is none."""
    from mend.server.report.fleet_history import FleetHistory
    from mend.server.report.fleet_page import tables_of, write_fleet_csv, write_fleet_report
    from mend.server.report.span import Span

    events = _events_of(journal)
    history = FleetHistory.of(
        _site_of(journal, events, site), events, span or Span.read(None, None)
    )
    if not history.within:
        raise CommandLineError(f"'{journal}' has no events of this fleet in that time")
    tables = tables_of(history)
    output.parent.mkdir(parents=True, exist_ok=True)
    write_fleet_report(output, history, tables)
    if csv is not None:
        write_fleet_csv(csv, history, tables)


def _events_of(journal: Path) -> "list[ev.Event]":
    from mend.server.journal.events import Event
    from mend.server.journal.reader import JournalReader
    from mend.server.report.fleet_history import TYPES

    with JournalReader(journal) as reader:
        found = list(reader.of_types(TYPES))
    readable = [each for each in found if isinstance(each, Event)]
    if unreadable := len(found) - len(readable):
        typer.echo(f"{unreadable} events could not be read, and are not counted", err=True)
    return readable


def _site_of(journal: Path, events: "Sequence[ev.Event]", site: UUID | None) -> UUID:
    """The site whose fleet is meant. Raises `CommandLineError`."""
    from mend.server.journal.events import FleetEvent

    sites = sorted({each.site for each in events if isinstance(each, FleetEvent)}, key=str)
    if site is None and len(sites) > 1:
        known = ", ".join(map(str, sites))
        raise CommandLineError(f"'{journal}' has several fleets: say which --site of {known}")
    wanted = site or (sites[0] if sites else None)
    if wanted is None or wanted not in sites:
        of = "" if site is None else f" of site {site}"
        raise CommandLineError(f"'{journal}' has no events of a fleet{of}: nobody asked there")
    return wanted
