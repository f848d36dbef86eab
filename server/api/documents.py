"""Task trees, scenes and scenarios over REST: the same doors for every kind."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response

from mend.server.api.document_upload import DocumentUpload, read_upload
from mend.server.api.json_answer import json_answer
from mend.server.api.problems import ProblemError, documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import (
    DocumentName,
    Limit,
    Offset,
    Services,
    WithCaller,
    WithServices,
    services_of,
)
from mend.server.documents import (
    SPOKEN,
    DocumentCheck,
    DocumentKind,
    DocumentLibrary,
    DocumentSummary,
    DocumentView,
    KeptDocument,
    ScenarioSummary,
    SceneSummary,
)
from mend.server.journal.events import Author
from mend.tasks.scene import Name

YAML_TYPES = ("application/yaml", "application/x-yaml", "text/yaml", "text/x-yaml")

TREE_EXAMPLE = """\
name: two_boxes
tree:
  then:
    - {behavior: pick_and_place, object: red_box, place: left}
    - {behavior: pick_and_place, object: blue_box, place: right}
"""
SCENE_EXAMPLE = """\
name: one_box
objects:
  red_box: {color: [1.0, 0.1, 0.1], size: [0.04, 0.06, 0.05], pose: {x: 0.5, y: -0.4}}
places:
  left: {pose: {x: 0.5, y: 0.0}}
"""
SCENARIO_EXAMPLE = """\
name: eket_stolen_bar
tree: eket
interventions:
  - {when: {object: pink_bar, step: 4}, do: {act: steal, object: pink_bar}}
answers: [yes]
"""


@dataclass(frozen=True, slots=True)
class Doors:
    """What differs from kind to kind: the path, the library, how a list looks, an example."""

    kind: DocumentKind
    path: str
    library: Callable[[Services], DocumentLibrary]
    summary: type[DocumentSummary]
    example: str


def _upload_body(doors: Doors) -> dict[str, Any]:
    return {
        "requestBody": {
            "required": True,
            "content": {
                "application/json": {
                    "schema": DocumentUpload.model_json_schema(),
                    "example": {"text": doors.example},
                },
                "application/yaml": {"schema": {"type": "string"}, "example": doors.example},
            },
        }
    }


def _router(doors: Doors) -> APIRouter:
    """The routes of one kind of document."""
    router = APIRouter(prefix="/api", tags=[doors.path.lstrip("/")], route_class=RepeatableRoute)
    _add_reading(router, doors)
    _add_writing(router, doors)
    return router


def _add_reading(router: APIRouter, doors: Doors) -> None:
    kind, what = doors.kind, SPOKEN[doors.kind]

    @router.get(
        doors.path,
        operation_id=f"list_{kind}s",
        response_model=list[doors.summary],  # type: ignore[name-defined]
        description=f"Every {what} that a run may name.",
        responses=documented(401, 421, 422),
    )
    async def list_documents(
        services: WithServices, limit: Limit = 1000, offset: Offset = 0
    ) -> Sequence[DocumentSummary]:
        return await doors.library(services).summaries(offset, limit)

    @router.get(
        f"{doors.path}/{{name}}",
        operation_id=f"get_{kind}",
        response_model=DocumentView,
        description=f"One {what} with its file's text.",
        responses=documented(401, 404, 421, 422),
    )
    async def get_document(name: DocumentName, services: WithServices) -> Response:
        return json_answer((await doors.library(services).get(name)).json)

    @router.post(
        f"{doors.path}/check",
        operation_id=f"check_{kind}",
        response_model=DocumentCheck,
        description=f"Check a {what} without keeping it: its definition, or every mistake with "
        "its line, and what keeps the robot of which world from doing it.",
        responses=documented(400, 401, 403, 413, 415, 421, 422),
        openapi_extra=_upload_body(doors),
    )
    async def check_document(request: Request, services: WithServices) -> Response:
        upload = await _read_upload(request, None)
        return json_answer((await doors.library(services).check(upload.text, upload.name)).json)


def _add_writing(router: APIRouter, doors: Doors) -> None:
    kind, what = doors.kind, SPOKEN[doors.kind]
    replaced: dict[int | str, dict[str, Any]] = {
        200: {"model": KeptDocument, "description": f"An uploaded {what} was replaced."},
        **documented(400, 401, 403, 409, 413, 415, 421, 422),
    }

    async def keep(upload: DocumentUpload, services: Services, author: Author) -> Response:
        kept = await doors.library(services).save(upload.name, upload.text, author)
        location = {"Location": f"/api{doors.path}/{kept.name}"}
        return json_answer(kept.view.json, status=201 if kept.new else 200, headers=location)

    @router.post(
        doors.path,
        operation_id=f"upload_{kind}",
        status_code=201,
        response_model=KeptDocument,
        description=f"Check a {what} and keep it under the name in its file, or the one sent.",
        responses=replaced,
        openapi_extra=_upload_body(doors),
    )
    async def upload_document(
        request: Request,
        services: WithServices,
        caller: WithCaller,
        name: Annotated[Name | None, Query(description="For a YAML body: its name.")] = None,
    ) -> Response:
        return await keep(await _read_upload(request, name), services, caller.author)

    @router.put(
        f"{doors.path}/{{name}}",
        operation_id=f"put_{kind}",
        status_code=201,
        response_model=KeptDocument,
        description=f"Check a {what} and keep it under this name.",
        responses=replaced,
        openapi_extra=_upload_body(doors),
    )
    async def put_document(
        name: DocumentName, request: Request, services: WithServices, caller: WithCaller
    ) -> Response:
        return await keep(await _read_upload(request, name), services, caller.author)

    @router.delete(
        f"{doors.path}/{{name}}",
        operation_id=f"delete_{kind}",
        status_code=204,
        description=f"Delete an uploaded {what}; runs that were started with it go on.",
        responses=documented(401, 403, 404, 409, 421, 422),
    )
    async def delete_document(
        name: DocumentName, services: WithServices, caller: WithCaller
    ) -> None:
        await doors.library(services).delete(name, caller.author)


async def _read_upload(request: Request, name: str | None) -> DocumentUpload:
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    body = await request.body()
    if kind in YAML_TYPES:
        return DocumentUpload(name=name, text=_decode(body))
    if kind != "application/json":
        raise ProblemError(
            415, "send the file as application/json with a 'text', or as application/yaml"
        )
    upload = await services_of(request).off_loop.run(len(body), read_upload, body)
    return upload if name is None else upload.model_copy(update={"name": name})


def _decode(body: bytes) -> str:
    try:
        return body.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ProblemError(400, f"the body is not UTF-8: byte {error.start} is wrong") from None


DOORS = (
    Doors(
        DocumentKind.TREE, "/trees", lambda services: services.trees, DocumentSummary, TREE_EXAMPLE
    ),
    Doors(
        DocumentKind.SCENE, "/scenes", lambda services: services.scenes, SceneSummary, SCENE_EXAMPLE
    ),
    Doors(
        DocumentKind.SCENARIO,
        "/scenarios",
        lambda services: services.scenarios,
        ScenarioSummary,
        SCENARIO_EXAMPLE,
    ),
)

router = APIRouter()
for each in DOORS:
    router.routes.extend(_router(each).routes)
