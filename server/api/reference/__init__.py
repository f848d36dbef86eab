"""The reference of the API at /docs: Swagger UI from an installed package, no other host."""

from importlib.resources import files
from pathlib import Path

from fastapi import APIRouter
from starlette.responses import FileResponse, Response

from mend.errors import NotFoundError

router = APIRouter(include_in_schema=False)

_OWN = Path(__file__).parent / "files"
# Only the files of this package are used: its pages have inline scripts, which no strict policy
# allows.
_SWAGGER_UI = Path(str(files("fastapi_offline"))) / "static"

FILES = {
    "start.js": (_OWN / "start.js", "text/javascript"),
    "swagger-ui-bundle.js": (_SWAGGER_UI / "swagger-ui-bundle.js", "text/javascript"),
    "swagger-ui.css": (_SWAGGER_UI / "swagger-ui.css", "text/css"),
}

HEADERS = {
    "Content-Security-Policy": (
        # Swagger UI's style sheet has its icons as data.
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:;"
        " connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
}


@router.get("/docs")
async def index() -> Response:
    return FileResponse(_OWN / "index.html", media_type="text/html", headers=HEADERS)


@router.get("/docs/{name}")
async def file(name: str) -> Response:
    if name not in FILES:
        raise NotFoundError(f"the reference has no file '{name}'")
    path, media_type = FILES[name]
    return FileResponse(path, media_type=media_type, headers=HEADERS)
