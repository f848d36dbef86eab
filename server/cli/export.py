"""`mend export`: a run as a file for other programs, from its journal."""

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal
from uuid import UUID

import typer

from mend.server.cli.failures import told_plainly

if TYPE_CHECKING:
    from mend.server.cli.found_run import FoundRun
    from mend.server.export.run_file import Format
    from mend.server.journal import events as ev
    from mend.server.journal.subscriptions import Record
    from mend.server.poses.frame import Frame


def export(
    run: Annotated[
        str, typer.Argument(metavar="RUN", help="The run's id, or enough of its beginning.")
    ],
    form: Annotated[
        Literal["csv", "mcap"],
        typer.Option(
            "--format", help="csv: its events; mcap: also poses and pictures, for Foxglove."
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE", help="Where to write it; RUN.FORMAT without it."
        ),
    ] = None,
    journal: Annotated[
        Path | None,
        typer.Option(help="The journal that has the run; without it, all known ones are searched."),
    ] = None,
) -> None:
    """Write a run that a journal holds as a file for other programs."""
    from mend.server.cli.found_run import find_run
    from mend.server.cli.journals import known_journals
    from mend.server.export.run_file import Format

    with told_plainly():
        found = find_run([journal] if journal else known_journals(), run, exact=journal is not None)
        path = output or Path(f"{found.run}.{form}")
        path.parent.mkdir(parents=True, exist_ok=True)
        asyncio.run(_write(path, found, Format(form)))
    typer.echo(path)


async def _write(path: Path, found: "FoundRun", form: "Format") -> None:
    from mend.server.export.run_pieces import RunSource, pieces_of
    from mend.server.journal.reader import JournalReader
    from mend.server.journal.stored_event import read_event
    from mend.server.poses.record import RecordedFrames, layout_path, read_layout, record_path

    async def event(record: "Record") -> "ev.Event":
        return read_event(record.seq, record.text, where=f" of '{found.journal}'")

    async def records() -> "AsyncIterator[Record]":
        for each in reader.records(found.run):
            yield each

    async def picture(picture: UUID) -> bytes | None:
        return reader.pictures([picture]).get(picture)

    async def until(time_s: float) -> "list[Frame]":
        return frames.until(time_s)

    poses = found.journal.with_suffix(".poses")
    frames = RecordedFrames(record_path(poses, found.run))
    draft = path.with_name(f"{path.name}.part")
    try:
        with JournalReader(found.journal) as reader, reader.at_one_moment():
            layout = read_layout(layout_path(poses, found.run))
            source = RunSource(records(), event, picture, until, layout)
            with draft.open("wb") as file:
                async for piece in pieces_of(source, form):
                    file.write(piece)
        draft.replace(path)
    finally:
        frames.close()
        draft.unlink(missing_ok=True)
