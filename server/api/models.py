"""The models of robots over REST: their files, for drawing them, and robots' own ones."""

from collections.abc import Iterator
from itertools import chain
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, StreamingResponse

from mend.documents.spellings import SEEN_CHARACTERS
from mend.errors import NotFoundError
from mend.robots.link.shown_name import SHOWN
from mend.server.access.principal import Caller
from mend.server.api.problems import ProblemError, documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import Limit, Offset, Services, WithCaller, WithServices
from mend.server.models.archive_names import URDF, kind_of
from mend.server.models.own_model import OwnModel
from mend.server.models.robot_models import own_address
from mend.server.models.views import ModelFileView, ModelView

router = APIRouter(prefix="/api", tags=["models"], route_class=RepeatableRoute)

CACHED = "private, max-age=3600"
MEDIA_TYPES = {
    ".urdf": "application/xml",
    ".stl": "model/stl",
    ".dae": "model/vnd.collada+xml",
    ".obj": "model/obj",
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".jpeg": "image/jpeg",
}
ARCHIVE, DESCRIPTIONS = "application/zip", ("application/xml", "text/xml")

ServedName = Annotated[str, Path(min_length=1, max_length=128, examples=["pr2"])]
OwnName = Annotated[
    str, Path(min_length=1, max_length=128, pattern=SEEN_CHARACTERS, examples=["arm-1"]), SHOWN
]
FileName = Annotated[str, Path(min_length=1, max_length=256, examples=[URDF])]

BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            ARCHIVE: {"schema": {"type": "string", "format": "binary"}},
            DESCRIPTIONS[0]: {"schema": {"type": "string"}},
        },
    }
}


@router.get("/models", operation_id="list_models", responses=documented(401, 403, 421, 422))
async def list_models(
    services: WithServices, limit: Limit = 1000, offset: Offset = 0
) -> list[ModelView]:
    """Every model by whose name a robot may say how it is drawn."""
    worlds = services.models.worlds
    built_in = [
        ModelView(name=each, built_in=True, urdf=await run_in_threadpool(worlds.address, each))
        for each in worlds.names()
    ]
    return [*built_in, *map(_view, services.models.own.all())][offset : offset + limit]


@router.get(
    "/models/{model}",
    operation_id="get_model",
    response_class=Response,
    responses={
        200: {"content": {ARCHIVE: {}}, "description": "A ZIP, as it may be given again."},
        304: {"description": "It is still the one of this `If-None-Match`."},
        **documented(401, 403, 404, 421, 422, 500),
    },
)
async def get_model(model: ServedName, request: Request, services: WithServices) -> Response:
    """An uploaded model with all of its files."""
    if model in services.models.worlds:
        raise NotFoundError(
            f"the robot model '{model}' is that of a world, of which there is no archive: take its "
            f"files from /api/models/{model}/{URDF} on"
        )
    own = _uploaded(services, model)
    headers = {**_headers(f'"{own.version}"'), "Cache-Control": "no-cache"}
    if _is_known(request, headers):
        return Response(status_code=304, headers=headers)
    return await _in_pieces(own.whole(), own.stored_bytes, ARCHIVE, headers)


CHANGES = documented(401, 403, 409, 413, 415, 421, 422, 503)
KEPT: dict[int | str, dict[str, Any]] = {
    200: {"model": ModelView, "description": "An uploaded model was replaced."},
    **CHANGES,
}


@router.put(
    "/models/{model}",
    operation_id="put_model",
    status_code=201,
    responses=KEPT,
    openapi_extra=BODY,
)
async def put_model(
    model: OwnName, request: Request, response: Response, services: WithServices, caller: WithCaller
) -> ModelView:
    """Keep a robot's model: a ZIP with `robot.urdf` and its meshes, or a URDF without any."""
    return await _keep(model, request, response, services, caller)


@router.put(
    "/robots/own_model",
    operation_id="put_own_model",
    status_code=201,
    responses=KEPT,
    openapi_extra=BODY,
)
async def put_own_model(
    request: Request, response: Response, services: WithServices, caller: WithCaller
) -> ModelView:
    """Keep the model of the robot that asks, under the name that its credential has."""
    return await _keep(caller.principal.name, request, response, services, caller)


@router.delete(
    "/models/{model}",
    operation_id="delete_model",
    status_code=204,
    responses=documented(401, 403, 404, 409, 421, 422, 503),
)
async def delete_model(model: OwnName, services: WithServices, caller: WithCaller) -> None:
    """Delete an uploaded model; a gripper stands for its robots then."""
    await services.models.own.delete(model, caller.author)


@router.delete(
    "/robots/own_model",
    operation_id="delete_own_model",
    status_code=204,
    responses=documented(401, 403, 404, 409, 421, 503),
)
async def delete_own_model(services: WithServices, caller: WithCaller) -> None:
    """Delete the model of the robot that asks."""
    await services.models.own.delete(caller.principal.name, caller.author)


async def _keep(
    model: str, request: Request, response: Response, services: Services, caller: Caller
) -> ModelView:
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != ARCHIVE and kind not in DESCRIPTIONS:
        raise ProblemError(
            415, f"send the model as {ARCHIVE}, or a URDF without meshes as {DESCRIPTIONS[0]}"
        )
    sent, packed = await request.body(), kind == ARCHIVE
    kept, new = await services.models.own.keep(model, sent, caller.author, packed=packed)
    response.status_code = 201 if new else 200
    return _view(kept)


def _view(own: OwnModel) -> ModelView:
    return ModelView(
        name=own.name,
        built_in=False,
        urdf=own_address(own.name, own.version),
        version=own.version,
        files=[ModelFileView(name=name, bytes=size) for name, size in own.sizes.items()],
    )


@router.get(
    "/models/{model}/{file:path}",
    operation_id="get_model_file",
    response_class=Response,
    responses={
        200: {"content": {"application/octet-stream": {}}, "description": "The file."},
        304: {"description": "It is still the one of this `If-None-Match`."},
        **documented(401, 404, 421, 422, 500),
    },
)
async def get_model_file(
    model: ServedName, file: FileName, request: Request, services: WithServices
) -> Response:
    """A model's description (`robot.urdf`), or a file that it names relative to itself."""
    if model not in services.models.worlds:
        return await _own_file(_uploaded(services, model), file, request)
    found = await run_in_threadpool(services.models.worlds.file, model, file)
    stat = found.stat()
    headers = _headers(f'"{stat.st_mtime_ns:x}-{stat.st_size:x}"')
    if _is_known(request, headers):
        return Response(status_code=304, headers=headers)
    return FileResponse(found, media_type=_media_type(file), headers=headers, stat_result=stat)


def _uploaded(services: Services, model: str) -> OwnModel:
    own = services.models.own.get(model)
    if own is None:
        raise NotFoundError(f"there is no robot model '{model}'")
    return own


async def _own_file(own: OwnModel, file: str, request: Request) -> Response:
    headers = _headers(f'"{own.version}"')
    if _is_known(request, headers):
        return Response(status_code=304, headers=headers)
    size = own.sizes[own.inside(file)]
    return await _in_pieces(own.pieces(file), size, _media_type(file), headers)


async def _in_pieces(
    pieces: Iterator[bytes], size: int, media_type: str, headers: dict[str, str]
) -> Response:
    """A few clients that read slowly would otherwise take the room of as many files."""
    first = await run_in_threadpool(next, pieces, b"")
    headers = {**headers, "Content-Length": str(size)}
    return StreamingResponse(chain([first], pieces), media_type=media_type, headers=headers)


def _headers(etag: str) -> dict[str, str]:
    return {"Cache-Control": CACHED, "ETag": etag}


def _is_known(request: Request, headers: dict[str, str]) -> bool:
    return request.headers.get("if-none-match") == headers["ETag"]


def _media_type(file: str) -> str:
    return MEDIA_TYPES.get(kind_of(file), "application/octet-stream")
