"""The helper console: the page that `web/` is built into, served with every view's address."""

from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Header
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, Response

from mend.errors import NotFoundError

router = APIRouter(include_in_schema=False)

BUILT = Path(__file__).parent / "built"

TYPES = {
    ".css": "text/css",
    ".html": "text/html",
    ".js": "text/javascript",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".webmanifest": "application/manifest+json",
}

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:;"
        " media-src 'self' blob:; worker-src 'self'; connect-src 'self'; manifest-src 'self';"
        " base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Vary": "Accept-Encoding",
}

CHECK_AGAIN = {"Cache-Control": "no-cache"}
# The names of assets carry a hash of what is in them.
KEEP = {"Cache-Control": "public, max-age=31536000, immutable"}

NO_VIEWS = ("/api/", "/ws/", "/assets/")

NOT_BUILT = (
    "<!doctype html><title>Mend</title><p>The console is not built here. Run <code>make console"
    "</code> in the project's folder; the service itself works without it.</p>"
)

Accepted = Annotated[str, Header(alias="accept-encoding")]


@router.get("/")
@router.get("/runs")
@router.get("/runs/{run}")
@router.get("/trees")
@router.get("/trees/{tree}")
@router.get("/scenes")
@router.get("/edit_scene")
@router.get("/edit_scene/{scene}")
@router.get("/edit")
@router.get("/edit/{tree}")
@router.get("/start")
@router.get("/start/{tree}")
@router.get("/fleet")
@router.get("/fleet/{site}")
@router.get("/requests")
@router.get("/robots/{robot}/ask")
@router.get("/settings")
async def view(accept_encoding: Accepted = "") -> Response:
    """The page; which view it shows is its own business."""
    if not (BUILT / "index.html").is_file():
        return HTMLResponse(NOT_BUILT, 503, HEADERS | CHECK_AGAIN)
    return _file("index.html", accept_encoding, CHECK_AGAIN)


def page_of_nothing(request: Request) -> Response | None:
    """The page that says in words that there is nothing at an address; None for other programs."""
    asks_for_page = request.method == "GET" and "text/html" in request.headers.get("accept", "")
    if not asks_for_page or request.url.path.startswith(NO_VIEWS):
        return None
    if not (BUILT / "index.html").is_file():
        return None
    return _file("index.html", request.headers.get("accept-encoding", ""), CHECK_AGAIN, 404)


@router.get("/assets/{name}")
async def asset(name: str, accept_encoding: Accepted = "") -> Response:
    """A part of the page."""
    return _file(f"assets/{name}", accept_encoding, KEEP)


@router.get("/icon.svg")
async def icon(accept_encoding: Accepted = "") -> Response:
    """The icon."""
    return _file("icon.svg", accept_encoding, CHECK_AGAIN)


@router.get("/icons/{name}")
async def other_icon(name: str) -> Response:
    """The icon as devices want it that install the page or show a notification."""
    return _file(f"icons/{name}", "", CHECK_AGAIN)


@router.get("/manifest.webmanifest")
async def manifest(accept_encoding: Accepted = "") -> Response:
    """What a device needs to know to install the page."""
    return _file("manifest.webmanifest", accept_encoding, CHECK_AGAIN)


@router.get("/service_worker.js")
async def service_worker(accept_encoding: Accepted = "") -> Response:
    """What shows calls while no page is open; a browser looks each time whether it is new."""
    return _file("service_worker.js", accept_encoding, CHECK_AGAIN)


def _file(name: str, accept_encoding: str, caching: dict[str, str], status: int = 200) -> Response:
    path = BUILT / name
    media_type = TYPES.get(path.suffix)
    if media_type is None or not path.is_file():
        raise NotFoundError(f"the console has no file '{name}'")
    headers = HEADERS | caching
    compressed = path.with_name(f"{path.name}.gz")
    if "gzip" in accept_encoding and compressed.is_file():
        path, headers = compressed, headers | {"Content-Encoding": "gzip"}
    return FileResponse(path, status, headers=headers, media_type=media_type)
