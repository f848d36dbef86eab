"""The helpers' WebSocket: a snapshot, then every event after it; answers and claims come back."""

import asyncio
from contextlib import AbstractContextManager, nullcontext
from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import BaseModel, Field
from starlette.websockets import WebSocket

from mend.server.access.roles import Role
from mend.server.api.helper_connection import (
    GOING_AWAY,
    TRY_AGAIN_LATER,
    HelperConnection,
    HelperQuery,
    until_one_ends,
)
from mend.server.api.helper_messages import (
    Answer,
    AnyClientMessage,
    Auth,
    Choose,
    Claim,
    Done,
    Extend,
    Here,
    Ping,
    Release,
    Result,
    SnapshotMessage,
    TakeBack,
    TroubleMessage,
    client_message,
)
from mend.server.api.problem import problem
from mend.server.api.problems import count_refusal, problem_of
from mend.server.api.services import MAX_SEQ
from mend.server.dialogues.attendance import Device, Presence
from mend.server.journal.events import NO_RUN
from mend.server.journal.journal import JournalClosedError
from mend.server.journal.subscriptions import PrunedEventsError, SubscriptionOverflowError
from mend.server.told_events import ToldEvents

router = APIRouter()

_RUN = '"run":"'

HELPER_PATH = "/ws/helper"
MAX_MESSAGE_CHARS = 64 * 1024


class EventsQuery(HelperQuery):
    """The address's parameters: who it is, the last event seen, and whether events have `lines`.

    `presence`: who is at the page from the start, as a `here` message says it later.
    """

    after: Annotated[int, Field(ge=0, le=MAX_SEQ)] | None = None
    told: bool = False
    presence: Presence | None = None


@router.websocket(HELPER_PATH)
async def helper_socket(websocket: WebSocket) -> None:
    """Serve one helper until either side has had enough."""
    await HelperSocket(websocket).run()


class HelperSocket(HelperConnection[EventsQuery]):
    """One helper's connection: events to them, answers and claims from them."""

    def __init__(self, websocket: WebSocket) -> None:
        super().__init__(HELPER_PATH, websocket, EventsQuery, MAX_MESSAGE_CHARS)

    async def _serve(self, query: EventsQuery, helper: str) -> None:
        """Send a snapshot, then events while taking messages, until one of the two ends."""
        seq = await self._send_snapshot(query.after)
        with self._attending(helper, query.presence) as self._device:
            await until_one_ends(
                self._send_events(seq, told=query.told),
                self._send_trouble(),
                self._receive_messages(helper),
            )

    def _attending(
        self, helper: str, presence: Presence | None
    ) -> AbstractContextManager[Device | None]:
        """Whoever may answer is there to be asked, for as long as this connection lasts."""
        may_answer = self._caller.principal.role.may(Role.HELPER)
        return self._parts.attendance.attending(helper, presence) if may_answer else nullcontext()

    # --- to the helper ------------------------------------------------------------------------

    async def _send_events(self, seq: int, *, told: bool) -> None:
        capacity = self._parts.settings.subscriber_queue
        telling = ToldEvents(self._parts.journal.index)
        with self._parts.journal.subscribe(seq, capacity) as subscription:
            try:
                async for record in subscription:
                    # What is of no run is for admins, and comes over REST.
                    if not _is_of_no_run(record.text):
                        text = await telling.told(record) if told else record.text
                        await self._websocket.send_text(text)
            except (SubscriptionOverflowError, PrunedEventsError) as error:
                await self._websocket.close(TRY_AGAIN_LATER, str(error))
            except JournalClosedError:
                await self._websocket.close(GOING_AWAY, "the service stops")
            else:
                await self._websocket.close(GOING_AWAY, "the service stops")

    async def _send_trouble(self) -> None:
        """Tell at once if the journal cannot be written, and of every change of that."""
        trouble = self._parts.journal.trouble
        news: asyncio.Queue[str | None] = asyncio.Queue()
        trouble.watch(news.put_nowait)
        try:
            if trouble.reason is not None:
                await self._send(TroubleMessage(reason=trouble.reason))
            while True:
                await self._send(TroubleMessage(reason=await news.get()))
        finally:
            trouble.unwatch(news.put_nowait)

    async def _send_snapshot(self, after: int | None) -> int:
        head = self._parts.journal.head
        ahead = after is not None and after > head
        pruned_through = await self._parts.journal.pruned_through()
        pruned = after is not None and after < pruned_through
        snapshot = await self._parts.runs.snapshot(None if ahead or pruned else after)
        await self._send(
            SnapshotMessage(seq=snapshot.seq, runs=snapshot.runs, dialogues=snapshot.dialogues)
        )
        if ahead:
            await self._refuse(
                problem(422, f"there is no event {after} yet: the last one is {head}")
            )
        if pruned:
            await self._refuse(
                problem(
                    410,
                    f"not every event after {after} is there any more: some up to "
                    f"{pruned_through} were pruned, so the snapshot is that of now",
                )
            )
        return snapshot.seq

    # --- from the helper ----------------------------------------------------------------------

    async def _receive_messages(self, helper: str) -> None:
        while True:
            received = await self._receive()
            if isinstance(received, bytes):
                await self._refuse(problem(422, "send text, not binary"))
                continue
            message = await self._read(received, client_message)
            if message is not None:
                await self._answer_message(message, helper)

    async def _answer_message(self, message: AnyClientMessage, helper: str) -> None:
        try:
            result = await self._do(message, helper)
        except Exception as error:
            refusal = problem_of(error)
            if refusal is None:
                raise
            count_refusal(error, self._parts.refusals)
            await self._refuse(refusal, message.id)
        else:
            await self._send(Result(id=message.id, result=result))

    async def _do(self, message: AnyClientMessage, helper: str) -> dict[str, Any]:
        runs = self._parts.runs
        match message:
            case Answer():
                done: BaseModel = await runs.dialogues.answer(
                    message.dialogue, message.prompt, message.answer, helper, self._author
                )
            case Choose():
                done = await runs.dialogues.choose(
                    message.dialogue, message.prompt, message.way, helper, self._author
                )
            case Claim():
                done = await runs.dialogues.claim(
                    message.dialogue, helper, take_over=message.take_over, author=self._author
                )
            case Release():
                done = await runs.dialogues.release(message.dialogue, helper, self._author)
            case Extend():
                done = await runs.dialogues.extend(
                    message.dialogue, message.prompt, helper, self._author
                )
            case Done():
                done = await runs.dialogues.said_done(message.dialogue, helper, self._author)
            case TakeBack():
                done = await runs.dialogues.take_back(message.dialogue, helper, self._author)
            case Here():
                if self._device is not None:
                    self._parts.attendance.says(helper, self._device, message.presence)
                return {"away_after_s": self._parts.attendance.away_after_s}
            case Auth() | Ping():
                return {}
        return done.model_dump(mode="json")


def _is_of_no_run(event: str) -> bool:
    """Whether an event's JSON says that it belongs to no run; its `run` comes before all else."""
    return event.startswith(str(NO_RUN), event.find(_RUN) + len(_RUN))
