"""A helper's WebSocket, whatever it carries: letting the helper in, reading, refusing, ending."""

import asyncio
import json
import time
from abc import ABC, abstractmethod
from collections.abc import Coroutine
from contextlib import suppress
from functools import partial
from typing import Any, Generic, TypeVar

from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError
from starlette.websockets import WebSocket, WebSocketDisconnect

from mend.server.access.admission import REFUSED
from mend.server.access.permissions import SOCKETS, needed_for_message
from mend.server.access.principal import Caller
from mend.server.api.helper_messages import Auth, Error, HelperMessage
from mend.server.api.mistakes import validation_sentences
from mend.server.api.problem import Problem, problem
from mend.server.api.problems import forbidden, problem_response
from mend.server.api.services import HelperName, Services, services_of
from mend.server.journal.events import Author
from mend.server.pace import Pace

THE_END = 1000
GOING_AWAY = 1001
POLICY_VIOLATION = 1008
TRY_AGAIN_LATER = 1013

FIRST_MESSAGE_S = 5.0
MAX_REASON_CHARS = 100
NO_LONGER_SIGNED_IN = "you are no longer signed in"
"""A close frame has room for 123 bytes."""


class HelperQuery(BaseModel):
    """The address's parameters: who it is, where their token does not say so."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    helper: HelperName | None = None


Query = TypeVar("Query", bound=HelperQuery)
Message = TypeVar("Message", bound=HelperMessage)


class HelperConnection(ABC, Generic[Query]):
    """One helper's connection at `path`, from the handshake to its end.

    `query` is the shape of the address's parameters; a text message has at most
    `max_message_chars`.
    """

    def __init__(
        self, path: str, websocket: WebSocket, query: type[Query], max_message_chars: int
    ) -> None:
        self._path = path
        self._websocket = websocket
        self._query = query
        self._max_message_chars = max_message_chars
        self._parts: Services = services_of(websocket)
        held_back = partial(self._parts.refusals.note, "helper_messages_per_s")
        most = self._parts.settings.limits.helper_messages_per_s
        self._pace = Pace(most, time.monotonic, held_back)

    async def run(self) -> None:
        """Let the helper in and serve them, until either side has had enough."""
        with suppress(WebSocketDisconnect):
            caller = await self._admitted()
            if caller is not None:
                await self._let_in(caller)

    async def _let_in(self, caller: Caller) -> None:
        self._caller = caller
        needed, role = SOCKETS[self._path], caller.principal.role
        if not role.may(needed):
            await self._turn_away(forbidden(needed, role))
            return
        try:
            query = self._query.model_validate(dict(self._websocket.query_params))
        except ValidationError as error:
            errors = validation_sentences(error.errors())
            await self._turn_away(problem(422, "the address is wrong", errors=errors))
            return
        helper = caller.helper_name(query.helper)
        if helper is None:
            missing = ["helper: is missing: with this token everybody says who it is"]
            await self._turn_away(problem(422, "the address is wrong", errors=missing))
            return
        with self._parts.access.watched(caller) as gone:
            await until_one_ends(self._serve(query, helper), self._leave_when(gone))

    async def _leave_when(self, gone: asyncio.Event) -> None:
        await gone.wait()
        await self._websocket.close(POLICY_VIOLATION, "you are no longer signed in")

    @abstractmethod
    async def _serve(self, query: Query, helper: str) -> None:
        """Everything after the helper has been let in. May raise `WebSocketDisconnect`."""

    # --- letting in ---------------------------------------------------------------------------

    async def _admitted(self) -> Caller | None:
        """Accept the connection and say who it is, or close it with 1008.

        Host and Origin are looked at first. The token comes in a bearer header, in the session
        cookie, or in the first message; never from the address, which ends up in logs.
        """
        websocket, access = self._websocket, self._parts.access
        if not (access.host_allowed(websocket) and access.origin_allowed(websocket)):
            await websocket.close(POLICY_VIOLATION, "this Host or Origin may not connect")
            return None
        await access.look()
        admission = await access.in_time(access.by_request(websocket))
        if admission.wait_s:
            refusal = problem(429, admission.too_many)
            await websocket.send_denial_response(problem_response(refusal, admission.retry_after))
            return None
        if "authorization" in websocket.headers and admission.caller is None:
            await websocket.close(POLICY_VIOLATION, "this is not the token")
            return None
        await websocket.accept()
        if admission.caller is None:
            token = await self._first_token()
            await access.look()
            shown = REFUSED if token is None else access.by_token(token, websocket)
            admission = await access.in_time(shown)
        if admission.wait_s:
            await self._turn_away(problem(429, admission.too_many), TRY_AGAIN_LATER)
        elif admission.caller is None:
            await websocket.close(POLICY_VIOLATION, "the first message must show the token")
        return admission.caller

    async def _first_token(self) -> str | None:
        """The token in the first message; None for any other message, and for none in time."""
        try:
            async with asyncio.timeout(FIRST_MESSAGE_S):
                first = await self._receive()
        except TimeoutError:
            self._parts.refusals.note("first_message_s")
            return None
        if not isinstance(first, str) or self._is_too_long(first):
            return None
        try:
            return Auth.model_validate_json(first).token
        except ValidationError:
            return None

    # --- from the helper ----------------------------------------------------------------------

    @property
    def _author(self) -> Author:
        """Who the helper is, for the journal."""
        return self._caller.author

    def _why_not(self, kind: str) -> Problem | None:
        """Why the helper may not send such a message, with the role that they have now."""
        caller = self._parts.access.renewed(self._caller)
        if caller is None:
            return problem(401, NO_LONGER_SIGNED_IN)
        self._caller = caller
        needed, role = needed_for_message(self._path, kind), caller.principal.role
        return None if needed is None or role.may(needed) else forbidden(needed, role)

    async def _receive(self) -> str | bytes:
        frame = await self._websocket.receive()
        if frame["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(frame.get("code", THE_END))
        text: str | None = frame.get("text")
        received = bytes(frame.get("bytes") or b"") if text is None else text
        await self._pace.keep(len(received))
        return received

    def _is_too_long(self, text: str) -> bool:
        """Whether a message is longer than it may be, which is counted."""
        too_long = len(text) > self._max_message_chars
        if too_long:
            self._parts.refusals.note("helper_message_chars")
        return too_long

    async def _read(self, text: str, shape: TypeAdapter[Message]) -> Message | None:
        """What a text message says; None for one that was refused, also for want of a role."""
        if self._is_too_long(text):
            limit = f"a message may have {self._max_message_chars} characters"
            await self._refuse(problem(413, limit))
            return None
        try:
            message = shape.validate_json(text)
        except ValidationError as error:
            errors = validation_sentences(error.errors(include_input=False))
            await self._refuse(problem(422, "the message is wrong", errors=errors), _id_in(text))
            return None
        await self._parts.access.look()
        refusal = self._why_not(vars(message)["type"])
        if refusal is not None:
            await self._refuse(refusal, message.id)
        return message if refusal is None else None

    # --- to the helper ------------------------------------------------------------------------

    async def _send(self, message: BaseModel) -> None:
        await self._websocket.send_text(message.model_dump_json())

    async def _refuse(self, refusal: Problem, to: str | int | None = None) -> None:
        """Say what cannot be done; the connection stays. `to`: the id of what was asked for."""
        fields = refusal.model_dump(include={"status", "title", "detail", "answered_by", "errors"})
        await self._send(Error(id=to, **fields))

    async def _turn_away(self, refusal: Problem, code: int = POLICY_VIOLATION) -> None:
        """Say why this connection cannot be served, and close it."""
        await self._refuse(refusal)
        await self._websocket.close(code, refusal.detail[:MAX_REASON_CHARS])


async def until_one_ends(*works: Coroutine[Any, Any, None]) -> None:
    """Run what sends and what receives; raises what either of them raised.

    When it returns, raises or is cancelled, none of them goes on.
    """
    tasks = [asyncio.create_task(work) for work in works]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        outcomes = await asyncio.gather(*tasks, return_exceptions=True)
    for outcome in outcomes:
        if isinstance(outcome, Exception):
            raise outcome


def _id_in(text: str) -> str | int | None:
    """The `id` of a message that is otherwise wrong, so that its sender knows which it was."""
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        return None
    found = message.get("id") if isinstance(message, dict) else None
    if isinstance(found, str):
        return found[:128].encode("utf-8", "replace").decode()
    return found if type(found) is int else None
