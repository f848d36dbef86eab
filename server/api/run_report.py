"""The report of a run over REST: one HTML file to keep."""

from collections.abc import Mapping, Sequence
from uuid import UUID

from fastapi import APIRouter, Response

from mend.server.api.problems import documented
from mend.server.api.services import RunId, Services, WithServices
from mend.server.journal.issue_index import IssuePage
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import Record

router = APIRouter(prefix="/api/runs", tags=["runs"])

PAGE = 1000


@router.get(
    "/{run}/report",
    operation_id="get_run_report",
    response_class=Response,
    responses={
        200: {"content": {"text/html": {}}, "description": "The report, as a file."},
        **documented(401, 404, 421, 422, 500, 503),
    },
)
async def get_run_report(run: RunId, services: WithServices) -> Response:
    """A run so far as an HTML file that needs no other: tree, times, faults, transcript."""
    summary = await services.runs.run_summary(run)
    records = await _records(run, services)
    pictures = await _pictures(run, services)
    texts = [(each.seq, each.text) for each in records]
    chars = sum(len(text) for _, text in texts)
    page = await services.off_loop.run(chars, rendered_report, texts, pictures)
    name = f"{summary.tree}-{summary.started:%Y%m%d-%H%M%S}.html"
    headers = {
        "Content-Disposition": f'attachment; filename="{name}"',
        "Cache-Control": "no-store",
    }
    return Response(page.encode(), media_type="text/html; charset=utf-8", headers=headers)


def rendered_report(texts: Sequence[tuple[int, str]], pictures: Mapping[UUID, bytes]) -> str:
    """The report of a run, given the `seq` and JSON of all its events.

    Raises `UnreadableEventError` for an event that cannot be read.
    """
    # Templates take a while to import, and no other request needs them.
    from mend.server.report.page import render_report

    return render_report([read_event(seq, text) for seq, text in texts], pictures)


async def _records(run: UUID, services: Services) -> list[Record]:
    records: list[Record] = []
    while page := await services.journal.read_records(records[-1].seq if records else 0, PAGE, run):
        records += page
    return records


async def _pictures(run: UUID, services: Services) -> dict[UUID, bytes]:
    """The pictures in which its issues were seen, those that are still kept."""
    pictures: dict[UUID, bytes] = {}
    before: int | None = None
    while page := await services.journal.issues.page(IssuePage(run=run, before=before, limit=PAGE)):
        for issue in page:
            jpeg = await services.journal.picture(issue.picture) if issue.picture else None
            if issue.picture is not None and jpeg is not None:
                pictures[issue.picture] = jpeg
        before = page[-1].seq
    return pictures
