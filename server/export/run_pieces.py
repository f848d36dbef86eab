"""A run written piece by piece: its events in their order, with what it showed between them."""

import json
import math
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import dataclass
from uuid import UUID

from mend.server.export.csv_file import CsvFile
from mend.server.export.mcap_file import McapFile
from mend.server.export.run_file import Format, RunFile, ShownPicture
from mend.server.export.run_order import ToldEvent, in_order
from mend.server.journal import events as ev
from mend.server.journal.subscriptions import Record
from mend.server.poses.layout import Layout
from mend.server.poses.record import ReadFrames
from mend.server.transcript import Transcript
from mend.server.turns import Turns

PIECE_BYTES = 64 * 1024
"""Pieces are at least so long, but for the last one."""


@dataclass(frozen=True, slots=True)
class RunSource:
    """Where a run is read: its events in order, each made of its record, pictures and frames.

    `picture` has None for one that is not kept any more.
    """

    records: AsyncIterator[Record]
    event: Callable[[Record], Awaitable[ev.Event]]
    picture: Callable[[UUID], Awaitable[bytes | None]]
    frames: ReadFrames
    layout: Layout | None


async def pieces_of(source: RunSource, form: Format) -> AsyncIterator[bytes]:
    """The file, of which no more is in memory than a piece and the longest event.

    Raises `JournalReadError` for what cannot be read.
    """
    file: RunFile | None = None
    ready = b""
    async for file in _growing(source, form):
        ready += file.take()
        if len(ready) >= PIECE_BYTES:
            yield ready
            ready = b""
    if file is not None:
        yield ready + file.end()


async def _growing(source: RunSource, form: Format) -> AsyncIterator[RunFile]:
    """The file after each thing that was added to it."""
    file: RunFile | None = None
    transcript = Transcript()
    turns = Turns()
    async for each in _told(source, form):
        if isinstance(each, ToldEvent):
            file = file or _begun(form, each.event, source.layout)
        if file is None:
            continue
        async for _ in _add_frames(file, source, each.time_s):
            yield file
        if isinstance(each, ToldEvent):
            file.add_event(each.event, each.text, transcript.lines(each.event))
        elif (jpeg := await source.picture(each.picture)) is not None:
            file.add_picture(each, jpeg)
        yield file
        await turns.pass_on()
    if file is not None:
        async for _ in _add_frames(file, source, math.inf):
            yield file


async def _told(source: RunSource, form: Format) -> AsyncIterator[ToldEvent | ShownPicture]:
    """What the file is made of, but for the poses; only one that shows pictures waits for them."""
    if form is not Format.CSV:
        async for each in in_order(source.records, source.event):
            yield each
        return
    async for record in source.records:
        yield ToldEvent(await source.event(record), record.text)


async def _add_frames(file: RunFile, source: RunSource, until_s: float) -> AsyncIterator[None]:
    """Add what was recorded up to a time; a step for each moment of it."""
    turns = Turns()
    while file.shows and (page := await source.frames(until_s)):
        for frame in page:
            file.add_frame(frame)
            yield
            await turns.pass_on()


def _begun(form: Format, first: ev.Event, layout: Layout | None) -> RunFile:
    if form is Format.CSV:
        return CsvFile()
    return McapFile(first.wall_time, first.time, layout)


def without_definitions(text: str) -> str:
    """An event's JSON without a tree, scene or script, which may be megabytes."""
    fields = json.loads(text)
    fields |= {name: {} for name in ("tree", "scene", "script") if fields.get(name)}
    return json.dumps(fields, ensure_ascii=False)
