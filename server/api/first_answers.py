"""The answer to a request that was made before, from what the journal says came of it.

That is for requests whose answer was not kept, as the service ended before it was known.
"""

from pydantic import BaseModel

from server.api.parts import Parts
from server.documents import DocumentKind, KeptDocument
from server.errors import ConflictError
from server.journal import events as ev
from server.journal.keyed_request import FirstAnswer

JSON = "application/json"


async def answer_of(seq: int, parts: Parts) -> FirstAnswer:
    """What a request is answered of which the event `seq` came.

    Raises `ConflictError` where that cannot be told any more.
    """
    events = await parts.journal.read(seq - 1, 1)
    if not events or events[0].seq != seq:
        raise _lost()
    status, body, location = await _of_event(events[0], parts)
    headers = [("content-type", JSON), *([("location", location)] if location else [])]
    return FirstAnswer(status, headers, body.model_dump_json().encode())


async def _of_event(event: ev.Event, parts: Parts) -> tuple[int, BaseModel, str | None]:
    match event:
        case ev.RunStarted(run=run):
            return 201, await parts.runs.run(run), f"/api/runs/{run}"
        case ev.RunPaused(run=run) | ev.RunResumed(run=run) | ev.RunAborted(run=run):
            return 200, await parts.runs.run(run), None
        case ev.InterventionAccepted(intervention=intervention):
            return 201, intervention, None
        case ev.Answered():
            return 201, event, None
        case ev.DeadlineExtended():
            return 200, event, None
        case ev.Claimed(dialogue=dialogue) | ev.Released(dialogue=dialogue):
            return 200, await parts.runs.dialogue(dialogue), None
        case ev.DocumentKept(kind=kind, name=name, replaced=replaced):
            kept = await _document(DocumentKind(kind), name, parts)
            return 200 if replaced else 201, kept, f"/api/{kind}s/{name}"
    raise _lost()


async def _document(kind: DocumentKind, name: str, parts: Parts) -> KeptDocument:
    library = {
        DocumentKind.TREE: parts.trees,
        DocumentKind.SCENE: parts.scenes,
        DocumentKind.SCENARIO: parts.scenarios,
    }[kind]
    found = await library.get(name)
    checked = await library.check(found.text)
    return KeptDocument(**dict(found), worlds=checked.worlds)


def _lost() -> ConflictError:
    return ConflictError("this request was done before, and its answer is not known any more")
