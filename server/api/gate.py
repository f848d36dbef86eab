"""The gate before every HTTP request: Host, Origin, token, role and the size of the body."""

from collections.abc import Callable, Mapping

from starlette.datastructures import MutableHeaders
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from mend.server.access.access import Access
from mend.server.access.permissions import needed_for_request
from mend.server.access.roles import Role
from mend.server.api.body_sizes import LARGE_BODY_BYTES, IncomingBodies, most_bytes
from mend.server.api.problem import problem
from mend.server.api.problems import forbidden, problem_response
from mend.server.api.safe_headers import OVER_TLS, SAFE_HEADERS
from mend.server.asking import NOBODY, asker
from mend.server.limits import Limits
from mend.server.refusals import Refusals

PROTECTED = ("/api/", "/metrics")
TOO_MANY_BODIES = "too many large bodies of requests come at once: send this one again later"
SHOW_TOKEN = "show the token: 'Authorization: Bearer ...', or sign in"
SAFE_METHODS = ("GET", "HEAD", "OPTIONS")


class Gate:
    """ASGI middleware that refuses what must not even be parsed."""

    def __init__(self, app: ASGIApp, access: Access, limits: Limits, refusals: Refusals) -> None:
        self._app = app
        self._access = access
        self._strangers_bytes = min(limits.stranger_body_bytes, LARGE_BODY_BYTES)
        self._incoming = IncomingBodies(limits.incoming_bytes)
        self._refusals = refusals

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        refusal = await self._refusal(scope, HTTPConnection(scope))
        guarded = _guarded(
            send,
            private=scope["path"].startswith(PROTECTED),
            encrypted=scope["scheme"] == "https",
        )
        if refusal is not None:
            await refusal(scope, receive, guarded)
            return
        with self._incoming.body() as has_room:
            await self._app(scope, self._limited(scope, receive, has_room), guarded)

    async def _refusal(self, scope: Scope, connection: HTTPConnection) -> Response | None:
        if not self._access.host_allowed(connection):
            return _refused(
                421, "this Host is not one of the service's names: add it to 'allowed_hosts'"
            )
        if scope["method"] not in SAFE_METHODS and not self._access.origin_allowed(connection):
            return _refused(403, "pages of this Origin may not do that: see 'allowed_origins'")
        refusal = await self._stranger(scope, connection)
        if refusal is not None:
            return refusal
        if _declared_length(connection) > self._most_bytes(scope):
            return _refused(413, self._too_large(scope))
        return None

    async def _stranger(self, scope: Scope, connection: HTTPConnection) -> Response | None:
        """Why who it is may not do that, or not yet.

        Whoever shows something is held to their pace at open doors, too, and so are those who are
        refused then.
        """
        await self._access.look()
        admission = await self._access.in_time(self._access.by_request(connection))
        if admission.wait_s:
            return _refused(429, admission.too_many, admission.retry_after)
        caller, needed = admission.caller, _needed(scope)
        state = scope.setdefault("state", {})
        state["known"] = caller
        asker.set(NOBODY if caller is None else caller.principal.name)
        if needed is None:
            return None
        if caller is None:
            return _refused(401, SHOW_TOKEN, {"WWW-Authenticate": "Bearer"})
        state["caller"] = caller
        role = caller.principal.role
        return None if role.may(needed) else problem_response(forbidden(needed, role))

    def _most_bytes(self, scope: Scope) -> int:
        """How large a body may be; much smaller where nobody had to say who they are."""
        if _needed(scope) is None:
            return self._strangers_bytes
        return most_bytes(scope["method"], scope["path"])

    def _too_large(self, scope: Scope) -> str:
        self._refusals.note("stranger_body_bytes" if _needed(scope) is None else "body_bytes")
        return f"the body is larger than {_spoken(self._most_bytes(scope))}"

    def _limited(self, scope: Scope, receive: Receive, has_room: Callable[[int], bool]) -> Receive:
        """A body without a declared length is counted as it comes.

        One that is still coming when the client hangs up, or the service stops, is refused like
        anything else.
        """
        received, complete, most = 0, False, self._most_bytes(scope)

        async def limited() -> Message:
            nonlocal received, complete
            message = await receive()
            if message["type"] == "http.disconnect":
                if complete or not _has_body(scope):
                    return message
                # Nobody reads this, but it ends the request without a defect in the log.
                raise HTTPException(400, "the connection ended before the body had come")
            received += len(message.get("body", b""))
            if received > most:
                raise HTTPException(413, self._too_large(scope))
            if not has_room(received):
                self._refusals.note("incoming_bytes")
                raise HTTPException(503, TOO_MANY_BODIES, {"Retry-After": "5"})
            if not (complete or message.get("more_body", False)):
                complete = True
                await self._look_again(scope)
            return message

        return limited

    async def _look_again(self, scope: Scope) -> None:
        """Refuse whoever may not do it any more, once the body has come: that took its time."""
        caller, needed = scope.get("state", {}).get("caller"), _needed(scope)
        if caller is None or needed is None:
            return
        await self._access.look()
        now = self._access.renewed(caller)
        if now is None:
            raise HTTPException(401, SHOW_TOKEN, {"WWW-Authenticate": "Bearer"})
        if not now.principal.role.may(needed):
            raise HTTPException(403, forbidden(needed, now.principal.role).detail)


def _needed(scope: Scope) -> Role | None:
    """The role that a request needs; None if anybody may send it."""
    path: str = scope["path"]
    return needed_for_request(scope["method"], path) if path.startswith(PROTECTED) else None


def _spoken(size: int) -> str:
    for unit, count in (("MiB", 1024**2), ("KiB", 1024)):
        if size % count == 0 and size >= count:
            return f"{size // count} {unit}"
    return f"{size} bytes"


def _refused(status: int, detail: str, headers: Mapping[str, str] | None = None) -> Response:
    return problem_response(problem(status, detail), headers)


def _guarded(send: Send, *, private: bool, encrypted: bool) -> Send:
    """Nothing can be misused by a page, and what is `private` is kept by nobody.

    A browser that has come `encrypted` is told to come in no other way.
    """

    async def guarded(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in SAFE_HEADERS.items():
                headers.setdefault(name, value)
            if encrypted:
                for name, value in OVER_TLS.items():
                    headers.setdefault(name, value)
            if private:
                headers.setdefault("Cache-Control", "no-store")
        await send(message)

    return guarded


def _has_body(scope: Scope) -> bool:
    names = {name for name, _ in scope["headers"]}
    return not names.isdisjoint({b"content-length", b"transfer-encoding"})


def _declared_length(connection: HTTPConnection) -> int:
    declared = connection.headers.get("content-length", "0")
    return int(declared) if declared.isascii() and declared.isdigit() else 0
