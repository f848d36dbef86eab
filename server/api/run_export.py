"""A run over REST as a file for other programs."""

from collections.abc import AsyncIterator
from typing import Annotated, Any
from uuid import UUID

from fastapi import APIRouter, Query
from fastapi.responses import StreamingResponse

from mend.server.api.problems import documented
from mend.server.api.services import RunId, Services, WithServices
from mend.server.export.run_file import MEDIA_TYPES, Format
from mend.server.export.run_pieces import RunSource, pieces_of, without_definitions
from mend.server.journal import events as ev
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import Record
from mend.server.off_loop import MUCH_CHARS

router = APIRouter(prefix="/api/runs", tags=["runs"])

PAGE = 200

FILE: dict[int | str, dict[str, Any]] = {
    200: {
        "content": {media.split(";")[0]: {} for media in MEDIA_TYPES.values()},
        "description": "The file.",
    }
}

Wanted = Annotated[Format, Query(alias="format", description="Which kind of file.")]


@router.get(
    "/{run}/export",
    operation_id="export_run",
    response_class=StreamingResponse,
    responses=FILE | documented(401, 404, 421, 422, 500),
)
async def export_run(run: RunId, form: Wanted, services: WithServices) -> StreamingResponse:
    """A run so far as a file: `csv` is its events, `mcap` its poses and pictures, too.

    It is sent as it is made, and ends where the run has come to by then.
    """
    summary = await services.runs.run_summary(run)
    name = f"{summary.tree}-{summary.started:%Y%m%d-%H%M%S}.{form}"
    headers = {
        "Content-Disposition": f'attachment; filename="{name}"',
        "Cache-Control": "no-store",
    }
    return StreamingResponse(
        _pieces(run, form, services), headers=headers, media_type=MEDIA_TYPES[form]
    )


async def _pieces(run: UUID, form: Format, services: Services) -> AsyncIterator[bytes]:
    async def event(record: Record) -> ev.Event:
        text, chars = record.text, len(record.text)
        if chars >= MUCH_CHARS:
            text = await services.off_loop.run(chars, without_definitions, text)
        return read_event(record.seq, text)

    layout = await services.poses.layout(run)
    async with services.poses.all_recorded(run) as frames:
        records = _records(run, services)
        source = RunSource(records, event, services.journal.picture, frames, layout)
        async for piece in pieces_of(source, form):
            yield piece


async def _records(run: UUID, services: Services) -> AsyncIterator[Record]:
    last, head = 0, services.journal.head
    while page := await services.journal.read_records(last, PAGE, run):
        for record in page:
            if record.seq > head:
                return
            yield record
        last = page[-1].seq
