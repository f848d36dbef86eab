"""Routes that take an idempotency key: a request under one is done once, however often it comes."""

import hashlib
from collections.abc import Callable, Coroutine
from dataclasses import replace
from typing import Any, ClassVar

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.types import Message

from mend.server.access.access import address_of
from mend.server.access.principal import Caller
from mend.server.access.tokens import bytes_of
from mend.server.api.first_answers import answer_of
from mend.server.api.idempotency_key import REPLAYED, key_in
from mend.server.api.repeats import Repeats
from mend.server.api.services import services_of
from mend.server.api.strict_json import StrictJsonRoute
from mend.server.household import household_of
from mend.server.journal.keyed_request import FirstAnswer, KeptRequest, KeyedRequest

KEY_CHARS = 16
"""So much of what a credential is known by tells it from a later one."""
KEPT_HEADERS = ("content-type", "location", "set-cookie")

Handle = Callable[[Request], Coroutine[Any, Any, Response]]


class RepeatableRoute(StrictJsonRoute):
    """A route whose POST requests may come under a key; what is refused leaves its key free."""

    answers_are_secret: ClassVar[bool] = False

    def get_route_handler(self) -> Handle:
        handle = super().get_route_handler()
        secret = self.answers_are_secret

        async def handle_once(request: Request) -> Response:
            key = key_in(request) if request.method == "POST" else None
            if key is None:
                return await handle(request)
            body = await request.body()
            keyed = _keyed(request, key, body)
            with services_of(request).repeats.under_way(keyed):
                return await _once(request, keyed, _with_body(request, keyed, body), handle, secret)

        return handle_once


class SecretRoute(RepeatableRoute):
    """Such a route with secrets in its answers, which must not be kept in the journal."""

    answers_are_secret: ClassVar[bool] = True


async def _once(
    request: Request, keyed: KeyedRequest, again: Request, handle: Handle, secret: bool
) -> Response:
    services = services_of(request)
    repeats: Repeats = services.repeats
    found: KeptRequest | None = await repeats.find(keyed)
    if found is not None and found.answer is not None:
        return _replayed(found.answer)
    if found is not None and found.seq:
        return _replayed(await answer_of(found.seq, services))
    response = await handle(again)
    if response.status_code < 300:
        await repeats.keep(keyed, _answer(response), secret=secret)
    return response


def _keyed(request: Request, key: str, body: bytes) -> KeyedRequest:
    said = (
        request.method,
        request.url.path,
        request.url.query,
        request.headers.get("content-type", ""),
    )
    head = bytes_of("\0".join(said))
    return KeyedRequest(_who(request), key, hashlib.sha256(head + b"\0" + body).digest())


def _who(request: Request) -> str:
    """Whose key it is: a principal's, or at an open door that of an address."""
    caller: Caller | None = getattr(request.state, "caller", None)
    if caller is not None:
        # Of two with one name, one after the other, neither gets what the other asked for.
        return f"{caller.principal.name}\0{caller.principal.key[:KEY_CHARS]}"
    # No principal's name has such a character.
    return "\0" + household_of(address_of(request))


def _with_body(request: Request, keyed: KeyedRequest, body: bytes) -> Request:
    """The request with a body that can be read once more, and a caller who asks under the key."""

    async def receive() -> Message:
        return {"type": "http.request", "body": body, "more_body": False}

    caller: Caller | None = getattr(request.state, "caller", None)
    if caller is not None:
        request.state.caller = replace(caller, request=keyed)
    return Request(request.scope, receive)


def _answer(response: Response) -> FirstAnswer | None:
    """What a request was answered; None where that is sent in pieces, as too long to be kept."""
    if isinstance(response, StreamingResponse):
        return None
    headers = [
        (name.decode("latin-1"), value.decode("latin-1"))
        for name, value in response.raw_headers
        if name.decode("latin-1") in KEPT_HEADERS
    ]
    return FirstAnswer(response.status_code, headers, bytes(response.body))


def _replayed(answer: FirstAnswer) -> Response:
    response = Response(answer.body, answer.status)
    for name, value in answer.headers:
        response.headers.append(name, value)
    response.headers[REPLAYED] = "true"
    return response
