"""The answer to a request that was made before, from what the journal says came of it.

That is for requests whose answer was not kept, as the service ended before it was known.
"""

from uuid import UUID

from pydantic import BaseModel

from mend.errors import ConflictError
from mend.server.api.json_answer import JSON
from mend.server.api.services import Services
from mend.server.documents import DocumentKind, DocumentLibrary
from mend.server.fleets.views import RequestView
from mend.server.journal import events as ev
from mend.server.journal.keyed_request import FirstAnswer
from mend.server.runtime.journaled_tree import read_without_tree


async def answer_of(seq: int, services: Services) -> FirstAnswer:
    """What a request is answered of which the event `seq` came.

    Raises `ConflictError` where that cannot be told any more.
    """
    records = await services.journal.read_records(seq - 1, 1)
    if not records or records[0].seq != seq:
        raise _lost()
    status, json, location = await _of_event(await read_without_tree(records[0]), services)
    headers = [("content-type", JSON), *([("location", location)] if location else [])]
    return FirstAnswer(status, headers, json)


async def _of_event(event: ev.Event, services: Services) -> tuple[int, bytes, str | None]:
    if isinstance(event, ev.DocumentKept):
        kept = await _library(DocumentKind(event.kind), services).kept(event.name)
        return 200 if event.replaced else 201, kept.json, f"/api/{event.kind}s/{event.name}"
    status, view, location = await _view_of(event, services)
    return status, view.model_dump_json().encode(), location


async def _view_of(event: ev.Event, services: Services) -> tuple[int, BaseModel, str | None]:
    match event:
        case ev.RunStarted(run=run):
            return 201, await services.runs.run_summary(run), f"/api/runs/{run}"
        case ev.RunPaused(run=run) | ev.RunResumed(run=run) | ev.RunAborted(run=run):
            return 200, await services.runs.run_summary(run), None
        case ev.InterventionAccepted(intervention=intervention):
            return 201, intervention, None
        case ev.Answered() | ev.RecordingBegun():
            return 201, event, None
        case ev.DeadlineExtended() | ev.HelpReported() | ev.PromiseTakenBack():
            return 200, event, None
        case ev.Claimed(dialogue=dialogue) | ev.Released(dialogue=dialogue):
            return 200, await services.runs.dialogues.view(dialogue), None
        case ev.RequestChanged(site=site, request=name):
            return await _booked(site, name, services)
    raise _lost()


async def _booked(site: UUID, name: str, services: Services) -> tuple[int, BaseModel, str]:
    """Of what recurs the event is that of some occurrence, the answer that of the first."""
    recurring, is_occurrence, _ = name.partition("/")
    first = f"{recurring}/1" if is_occurrence else name
    view = RequestView.of(*await services.fleets.request(site, first))
    return 201, view, f"/api/requests/{first}?site={site}"


def _library(kind: DocumentKind, services: Services) -> DocumentLibrary:
    return {
        DocumentKind.TREE: services.trees,
        DocumentKind.SCENE: services.scenes,
        DocumentKind.SCENARIO: services.scenarios,
    }[kind]


def _lost() -> ConflictError:
    return ConflictError("this request was done before, and its answer is not known any more")
