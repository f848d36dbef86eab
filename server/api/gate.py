"""The gate before every HTTP request: Host, Origin, token, role and the size of the body."""

import asyncio

from starlette.datastructures import MutableHeaders
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.access.permissions import needed_for_request
from server.access.principal import Caller
from server.api.access import Access
from server.api.problems import Problem, forbidden, problem, problem_response

MAX_BODY_BYTES = 8 * 1024 * 1024
PROTECTED = ("/api/", "/metrics")
SAFE_METHODS = ("GET", "HEAD", "OPTIONS")


class Gate:
    """ASGI middleware that refuses what must not even be parsed."""

    def __init__(self, app: ASGIApp, access: Access) -> None:
        self._app = app
        self._access = access

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        connection = HTTPConnection(scope)
        refusal = self._refusal(scope, connection)
        guarded = _guarded(send, private=scope["path"].startswith(PROTECTED))
        if refusal is None:
            await self._app(scope, _limited(receive), guarded)
            return
        headers = {"WWW-Authenticate": "Bearer"} if refusal.status == 401 else {}
        await problem_response(refusal, headers)(scope, receive, guarded)

    def _refusal(self, scope: Scope, connection: HTTPConnection) -> Problem | None:
        path: str = scope["path"]
        if not self._access.host_allowed(connection):
            return problem(
                421, "this Host is not one of the service's names: add it to 'allowed_hosts'"
            )
        if scope["method"] not in SAFE_METHODS and not self._access.origin_allowed(connection):
            return problem(403, "pages of this Origin may not do that: see 'allowed_origins'")
        caller = self._access.caller(connection)
        scope.setdefault("state", {})["caller"] = caller
        if path.startswith(PROTECTED):
            refusal = self._stranger(scope, connection, caller)
            if refusal is not None:
                return refusal
        if _declared_length(connection) > MAX_BODY_BYTES:
            return problem(413, _too_large())
        return None

    def _stranger(
        self, scope: Scope, connection: HTTPConnection, caller: Caller | None
    ) -> Problem | None:
        """Why who it is may not do that."""
        needed = needed_for_request(scope["method"], scope["path"])
        if needed is None:
            return None
        if caller is None:
            self._access.refused(connection)
            return problem(401, "show the token: 'Authorization: Bearer ...', or sign in")
        role = caller.principal.role
        return None if role.may(needed) else forbidden(needed, role)


def _guarded(send: Send, *, private: bool) -> Send:
    """Nothing is taken for another type than it says, and what is `private` is kept by nobody."""

    async def guarded(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers.setdefault("X-Content-Type-Options", "nosniff")
            if private:
                headers.setdefault("Cache-Control", "no-store")
        await send(message)

    return guarded


def _declared_length(connection: HTTPConnection) -> int:
    declared = connection.headers.get("content-length", "0")
    return int(declared) if declared.isascii() and declared.isdigit() else 0


def _limited(receive: Receive) -> Receive:
    """A body without a declared length is counted as it comes.

    One that is still coming when the service stops is refused like anything else.
    """
    received, complete = 0, False

    async def limited() -> Message:
        nonlocal received, complete
        try:
            message = await receive()
        except asyncio.CancelledError:
            if complete:
                raise
            raise HTTPException(503, "the service is shutting down") from None
        complete = not message.get("more_body", False)
        received += len(message.get("body", b""))
        if received > MAX_BODY_BYTES:
            raise HTTPException(413, _too_large())
        return message

    return limited


def _too_large() -> str:
    return f"the body is larger than {MAX_BODY_BYTES // 1024**2} MiB"
