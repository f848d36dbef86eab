"""Requests whose target is a whole URL, as a client sends them that takes a server for a proxy.

RFC 9112, 3.2.2: a server has to accept them, and the URL's authority counts, not the Host header.
"""

from contextlib import suppress
from urllib.parse import unquote, urlsplit

from starlette.types import ASGIApp, Receive, Scope, Send

SCHEMES = (b"http://", b"https://")


class AbsoluteForm:
    """ASGI middleware that takes such a target apart, for all who only know paths."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http" and scope.get("raw_path", b"").lower().startswith(SCHEMES):
            # One that cannot be taken apart is a path that there is not.
            with suppress(ValueError):
                scope = _in_origin_form(scope)
        await self._app(scope, receive, send)


def _in_origin_form(scope: Scope) -> Scope:
    url = urlsplit(bytes(scope["raw_path"]))
    path = url.path or b"/"
    others = [each for each in scope["headers"] if each[0] != b"host"]
    return {
        **scope,
        "path": unquote(path.decode("ascii")),
        "raw_path": path,
        "headers": [(b"host", url.netloc), *others],
    }
