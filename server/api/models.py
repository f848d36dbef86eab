"""The model files of robots, for drawing them."""

from typing import Annotated

from fastapi import APIRouter, Path, Request, Response
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse

from mend.server.api.problems import documented
from mend.server.api.services import WithServices

router = APIRouter(prefix="/api/models", tags=["models"])

CACHED = "private, max-age=3600"
MEDIA_TYPES = {".urdf": "application/xml", ".stl": "model/stl", ".dae": "model/vnd.collada+xml"}

ModelName = Annotated[str, Path(min_length=1, max_length=64, examples=["pr2"])]
FileName = Annotated[str, Path(min_length=1, max_length=256, examples=["robot.urdf"])]


@router.get(
    "/{model}/{file:path}",
    operation_id="get_model_file",
    response_class=Response,
    responses={
        200: {"content": {"application/octet-stream": {}}, "description": "The file."},
        304: {"description": "It is still the one of this `If-None-Match`."},
        **documented(401, 404, 421, 422),
    },
)
async def get_model_file(
    model: ModelName, file: FileName, request: Request, services: WithServices
) -> Response:
    """A model's description (`robot.urdf`), or a mesh that it names relative to itself."""
    found = await run_in_threadpool(services.models.file, model, file)
    stat = found.stat()
    etag = f'"{stat.st_mtime_ns:x}-{stat.st_size:x}"'
    headers = {"Cache-Control": CACHED, "ETag": etag}
    if request.headers.get("if-none-match") == etag:
        return Response(status_code=304, headers=headers)
    media_type = MEDIA_TYPES.get(found.suffix, "application/octet-stream")
    return FileResponse(found, media_type=media_type, headers=headers, stat_result=stat)
