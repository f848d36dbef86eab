"""The plain built-in page, for helping without the console."""

from pathlib import Path

from fastapi import APIRouter
from starlette.responses import FileResponse, Response

from server.errors import NotFoundError

router = APIRouter(include_in_schema=False)

FILES = Path(__file__).parent / "files"

TYPES = {
    "index.html": "text/html",
    "page.css": "text/css",
    "page.js": "text/javascript",
    "transcript.js": "text/javascript",
    "icon.svg": "image/svg+xml",
}

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self';"
        " connect-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
}


@router.get("/")
async def index() -> Response:
    return _file("index.html")


@router.get("/page/{name}")
async def file(name: str) -> Response:
    return _file(name)


def _file(name: str) -> Response:
    if name not in TYPES:
        raise NotFoundError(f"the page has no file '{name}'")
    return FileResponse(FILES / name, media_type=TYPES[name], headers=HEADERS)
