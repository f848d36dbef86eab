"""The helpers' WebSocket: a snapshot, then every event after it; answers and claims come back."""

import asyncio
import json
from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from starlette.websockets import WebSocket, WebSocketDisconnect

from server.api.admission import POLICY_VIOLATION, admit
from server.api.helper_messages import (
    Answer,
    AnyClientMessage,
    Auth,
    Claim,
    Error,
    Extend,
    Ping,
    Release,
    Result,
    SnapshotMessage,
    client_message,
)
from server.api.parts import MAX_SEQ, HelperName, Parts, parts_of
from server.api.problems import problem, problem_of, validation_sentences
from server.journal.journal import JournalClosedError
from server.journal.subscriptions import SubscriptionOverflowError

router = APIRouter()

MAX_MESSAGE_CHARS = 64 * 1024
TRY_AGAIN_LATER = 1013
GOING_AWAY = 1001


class HelperQuery(BaseModel):
    """The address's parameters: who it is, and the last event seen."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    helper: HelperName
    after: Annotated[int, Field(ge=0, le=MAX_SEQ)] | None = None


@router.websocket("/ws/helper")
async def helper_socket(websocket: WebSocket) -> None:
    """Serve one helper until either side has had enough."""
    socket = HelperSocket(websocket, parts_of(websocket))
    try:
        if await socket.admitted():
            await socket.serve()
    except WebSocketDisconnect:
        pass


class HelperSocket:
    """One helper's connection."""

    def __init__(self, websocket: WebSocket, parts: Parts) -> None:
        self._websocket = websocket
        self._parts = parts
        self._query = HelperQuery.model_construct(helper="")

    async def admitted(self) -> bool:
        """Let the helper in, with a name and a place in the journal."""
        if not await admit(self._websocket, self._parts.access, self._first_token):
            return False
        try:
            self._query = HelperQuery.model_validate(dict(self._websocket.query_params))
        except ValidationError as error:
            await self._refuse(422, "the address is wrong", validation_sentences(error.errors()))
            await self._websocket.close(POLICY_VIOLATION, "the address is wrong")
            return False
        return True

    async def serve(self) -> None:
        """Send a snapshot, then events while taking messages, until one of the two ends."""
        seq = await self._send_snapshot()
        sending = asyncio.create_task(self._send_events(seq))
        receiving = asyncio.create_task(self._receive_messages())
        await asyncio.wait((sending, receiving), return_when=asyncio.FIRST_COMPLETED)
        sending.cancel()
        receiving.cancel()
        ended = await asyncio.gather(sending, receiving, return_exceptions=True)
        for outcome in ended:
            if isinstance(outcome, Exception):
                raise outcome

    # --- to the helper ------------------------------------------------------------------------

    async def _send_events(self, seq: int) -> None:
        capacity = self._parts.settings.subscriber_queue
        with self._parts.journal.subscribe(seq, capacity) as subscription:
            try:
                async for record in subscription:
                    await self._websocket.send_text(record.text)
            except SubscriptionOverflowError as error:
                await self._websocket.close(TRY_AGAIN_LATER, str(error))
            except JournalClosedError:
                await self._websocket.close(GOING_AWAY, "the service stops")
            else:
                await self._websocket.close(GOING_AWAY, "the service stops")

    async def _send_snapshot(self) -> int:
        after = self._query.after
        head = self._parts.journal.head
        ahead = after is not None and after > head
        snapshot = await self._parts.runs.snapshot(None if ahead else after)
        await self._send(
            SnapshotMessage(seq=snapshot.seq, runs=snapshot.runs, dialogues=snapshot.dialogues)
        )
        if ahead:
            await self._refuse(422, f"there is no event {after} yet: the last one is {head}")
        return snapshot.seq

    async def _send(self, message: BaseModel) -> None:
        await self._websocket.send_text(message.model_dump_json(exclude_none=False))

    async def _refuse(
        self, status: int, detail: str, errors: list[str] | None = None, to: str | int | None = None
    ) -> None:
        refusal = problem(status, detail)
        await self._send(
            Error(id=to, status=status, title=refusal.title, detail=detail, errors=errors)
        )

    # --- from the helper ----------------------------------------------------------------------

    async def _receive_messages(self) -> None:
        while True:
            text = await self._receive_text()
            if text is None:
                continue
            try:
                message = client_message.validate_json(text)
            except ValidationError as error:
                errors = validation_sentences(error.errors(include_input=False))
                await self._refuse(422, "the message is wrong", errors, _id_in(text))
                continue
            await self._answer_message(message)

    async def _receive_text(self) -> str | None:
        """The next text message; None for one that was refused."""
        frame = await self._websocket.receive()
        if frame["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(frame.get("code", 1000))
        text: str | None = frame.get("text")
        if text is None:
            await self._refuse(422, "send text, not binary")
            return None
        if len(text) > MAX_MESSAGE_CHARS:
            await self._refuse(413, f"a message may have {MAX_MESSAGE_CHARS} characters")
            return None
        return text

    async def _first_token(self) -> str | None:
        text = await self._receive_text()
        try:
            message = client_message.validate_json(text or "")
        except ValidationError:
            return None
        return message.token if isinstance(message, Auth) else None

    async def _answer_message(self, message: AnyClientMessage) -> None:
        try:
            result = await self._do(message)
        except Exception as error:
            refusal = problem_of(error)
            if refusal is None:
                raise
            fields = refusal.model_dump(include={"status", "title", "detail", "answered_by"})
            await self._send(Error(id=message.id, errors=refusal.errors, **fields))
        else:
            await self._send(Result(id=message.id, result=result))

    async def _do(self, message: AnyClientMessage) -> dict[str, Any]:
        runs, helper = self._parts.runs, self._query.helper
        match message:
            case Answer():
                done: BaseModel = await runs.answer(
                    message.dialogue, message.prompt, message.answer, helper
                )
            case Claim():
                done = await runs.claim(message.dialogue, helper, take_over=message.take_over)
            case Release():
                done = await runs.release(message.dialogue, helper)
            case Extend():
                done = await runs.extend(message.dialogue, message.prompt, helper)
            case Auth() | Ping():
                return {}
        return done.model_dump(mode="json")


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
