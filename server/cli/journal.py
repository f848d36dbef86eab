"""`mend journal`: check, prune, back up and restore a journal."""

import asyncio
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any
from uuid import UUID

import typer

from mend.server.cli.failures import NOT_FINISHED, CommandLineError, told_plainly

if TYPE_CHECKING:
    from mend.server.journal.events import Event
    from mend.server.journal.full_check import Finding
    from mend.server.retention import KeepSettings

MOST_RUNS_NAMED = 10

app = typer.Typer(
    name="journal",
    help="Check, prune, back up and restore a journal.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

JournalFile = Annotated[
    Path | None, typer.Option("--journal", help="The journal's file; the service's own otherwise.")
]
Force = Annotated[bool, typer.Option("--force", help="Replace the file that is there.")]


@app.command("check", short_help="Find what is damaged in a journal.")
def check(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="The service's own without it.")
    ] = None,
) -> None:
    """Check every page, event and run of a journal, also while a service writes to it.

    The exit code is 1 if anything is wrong; one sentence then says what, and which runs it
    concerns.
    """
    from mend.dialogue.registry import load_scripts
    from mend.server.journal.full_check import check_journal
    from mend.server.runtime.history import fold_event

    with told_plainly():
        path = _journal(file)
        scripts = load_scripts()

        def fold(run: UUID, events: "Iterable[Event]") -> None:
            state = None
            for event in events:
                state = fold_event(run, state, event, scripts)

        found = check_journal(path, fold)
    for finding in found.findings:
        typer.echo(_told(finding))
    if found.findings:
        raise typer.Exit(NOT_FINISHED)
    typer.echo(f"{path}: {found.runs} runs, {found.events} events, nothing is wrong")


def _told(finding: "Finding") -> str:
    named = sorted(run for run in finding.runs if run not in finding.sentence)
    if not named:
        return finding.sentence
    more = len(named) - MOST_RUNS_NAMED
    runs = ", ".join(named[:MOST_RUNS_NAMED]) + (f" and {more} more" if more > 0 else "")
    return f"{finding.sentence} [runs {runs}]"


@app.command("prune", short_help="Delete ended runs that are not kept.")
def prune(
    days: Annotated[
        float | None, typer.Option(help="Keep runs that ended within so many days.")
    ] = None,
    runs: Annotated[int | None, typer.Option(help="Keep so many of those that ended last.")] = None,
    pictures_mb: Annotated[
        float | None, typer.Option(help="Keep so many megabytes of pictures, the newest.")
    ] = None,
    compact: Annotated[
        bool, typer.Option("--compact", help="Give the room back; no service may run.")
    ] = False,
    journal: JournalFile = None,
) -> None:
    """Delete ended runs with all that belongs to them; a service may go on writing meanwhile.

    Without options the settings say what is kept. Runs that have not ended are always kept.
    """
    from mend.server.journal.offline_pruning import prune_file

    with told_plainly():
        path = _journal(journal)
        settings = _keep(days=days, runs=runs, pictures_mb=pictures_mb)
        poses = path.with_suffix(".poses")

        def forget(run: UUID) -> None:
            for each in (f"{run}.poses", f"{run}.layout.json"):
                (poses / each).unlink(missing_ok=True)

        now = datetime.now(UTC)
        pruned = asyncio.run(prune_file(path, settings.keep(), now, forget, compact=compact))
    typer.echo(
        f"{path}: {len(pruned.runs)} runs, {pruned.events} events and {pruned.pictures} pictures "
        "were pruned"
    )


def _keep(**given: Any) -> "KeepSettings":
    """What the options say; what the settings say without any."""
    from pydantic import ValidationError

    from mend.server.retention import KeepSettings
    from mend.server.settings import load_settings

    chosen = {name: value for name, value in given.items() if value is not None}
    if not chosen:
        return load_settings().keep
    try:
        return KeepSettings(**chosen)
    except ValidationError as error:
        sentences = [
            f"--{'-'.join(map(str, each['loc'])).replace('_', '-')}: {each['msg'].lower()}"
            for each in error.errors()
        ]
        raise CommandLineError("\n".join(sentences)) from error


@app.command("backup", short_help="Copy a journal, also while it is written.")
def backup(
    target: Annotated[Path, typer.Argument(metavar="TARGET", help="The copy's file.")],
    journal: JournalFile = None,
    force: Force = False,
) -> None:
    """Copy a journal as it is at one moment; a service may go on writing meanwhile."""
    from mend.server.journal.backup import back_up

    with told_plainly():
        path = _journal(journal)
        back_up(path, target, force=force)
    typer.echo(f"{target}: a copy of {path}")


@app.command("restore", short_help="Put a backup in a journal's place.")
def restore(
    backup: Annotated[Path, typer.Argument(metavar="BACKUP", help="What `backup` has made.")],
    journal: JournalFile = None,
    force: Force = False,
) -> None:
    """Put a backup in a journal's place; the service must be stopped."""
    from mend.server.journal.backup import restore as put_back

    with told_plainly():
        path = _journal(journal)
        put_back(backup, path, force=force)
    typer.echo(f"{path}: restored from {backup}")


def _journal(file: Path | None) -> Path:
    from mend.server.settings import load_settings

    return file if file is not None else load_settings().journal_path
