"""The speech WebSocket: one helper's microphone, and the conversation that it is part of."""

import time
from uuid import UUID

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, ValidationError
from starlette.websockets import WebSocket, WebSocketDisconnect

from server.api.admission import POLICY_VIOLATION, admit
from server.api.helper_messages import Auth
from server.api.parts import HelperName, Parts, parts_of
from server.api.problems import problem, problem_of, validation_sentences
from server.api.speech_messages import (
    Cancel,
    Ended,
    GaveUp,
    HeardMessage,
    Hearing,
    Listen,
    Listening,
    Say,
    SpeechError,
    Spoken,
    speech_client_message,
)
from server.errors import ServiceError
from server.speech import conversation as talking
from server.speech.conversation import (
    Act,
    Conversation,
    EndReason,
    IllegalTransitionError,
    Saying,
)
from server.speech.ear import NoEars, TooManyConversationsError
from server.speech.phrases import help_text
from server.speech.question import open_question, wait_until_over
from server.speech.talk import Talk
from server.speech.voice import NoVoice

router = APIRouter()

MAX_MESSAGE_CHARS = 4 * 1024
MAX_SOUND_BYTES = 16 * 1024
"""Half a second."""


class SpeechQuery(BaseModel):
    """The address's parameters: who it is."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    helper: HelperName


@router.websocket("/ws/speech")
async def speech_socket(websocket: WebSocket) -> None:
    """Serve one helper's microphone until the connection ends."""
    socket = SpeechSocket(websocket, parts_of(websocket))
    try:
        if await socket.admitted():
            await socket.serve()
    except WebSocketDisconnect:
        pass


class SpeechSocket:
    """One helper's connection; at most one conversation at a time."""

    def __init__(self, websocket: WebSocket, parts: Parts) -> None:
        self._websocket = websocket
        self._parts = parts
        self._talk: Talk | None = None

    async def admitted(self) -> bool:
        """Let the helper in, with a name."""
        if not await admit(self._websocket, self._parts.access, self._first_token):
            return False
        try:
            SpeechQuery.model_validate(dict(self._websocket.query_params))
        except ValidationError as error:
            await self._refuse(422, "the address is wrong", validation_sentences(error.errors()))
            await self._websocket.close(POLICY_VIOLATION, "the address is wrong")
            return False
        return True

    async def serve(self) -> None:
        """Take messages and sound until the connection ends."""
        try:
            while True:
                received = await self._receive()
                if isinstance(received, bytes):
                    await self._take_sound(received)
                elif received is not None:
                    await self._take_text(received)
        finally:
            if self._talk is not None:
                await self._talk.close()

    # --- from the helper ----------------------------------------------------------------------

    async def _receive(self) -> str | bytes | None:
        """The next message; None for one that was refused."""
        frame = await self._websocket.receive()
        if frame["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(frame.get("code", 1000))
        text: str | None = frame.get("text")
        if text is None:
            return bytes(frame.get("bytes") or b"")
        if len(text) > MAX_MESSAGE_CHARS:
            await self._refuse(413, f"a message may have {MAX_MESSAGE_CHARS} characters")
            return None
        return text

    async def _first_token(self) -> str | None:
        received = await self._receive()
        if not isinstance(received, str):
            return None
        try:
            message = speech_client_message.validate_json(received)
        except ValidationError:
            return None
        return message.token if isinstance(message, Auth) else None

    async def _take_sound(self, pcm: bytes) -> None:
        if len(pcm) > MAX_SOUND_BYTES or len(pcm) % 2:
            await self._refuse(
                413 if len(pcm) > MAX_SOUND_BYTES else 422,
                f"sound comes in frames of whole 16-bit samples, at most {MAX_SOUND_BYTES} bytes",
            )
        elif self._talk is not None:
            self._talk.hear(pcm)

    async def _take_text(self, text: str) -> None:
        try:
            message = speech_client_message.validate_json(text)
        except ValidationError as error:
            errors = validation_sentences(error.errors(include_input=False))
            await self._refuse(422, "the message is wrong", errors)
            return
        try:
            await self._do(message)
        except IllegalTransitionError as error:
            await self._refuse(409, str(error), to=message.id)
        except TooManyConversationsError as error:
            await self._refuse(503, str(error), to=message.id)
        except ServiceError as error:
            refusal = problem_of(error)
            assert refusal is not None, "every other service error has a status"
            await self._refuse(refusal.status, refusal.detail, refusal.errors, message.id)

    async def _do(self, message: Auth | Listen | Spoken | Cancel) -> None:
        match message:
            case Listen():
                await self._begin(message)
            case Spoken() if self._talk is not None:
                await self._talk.spoken()
            case Spoken():
                await self._refuse(409, "there is no conversation", to=message.id)
            case Cancel():
                await self._end(EndReason.CANCELLED)
            case Auth():
                pass

    async def _begin(self, message: Listen) -> None:
        ears = self._parts.speech.ears
        if isinstance(ears, NoEars):
            await self._refuse(503, f"nothing can be recognized: {ears.why_not}", to=message.id)
            return
        question = open_question(self._parts.runs, message.dialogue, message.prompt)
        await self._end(EndReason.REPLACED)
        ears.check_room()
        over = wait_until_over(
            self._parts.runs,
            self._parts.journal,
            message.dialogue,
            message.prompt,
            self._parts.settings.subscriber_queue,
        )
        aloud = Aloud(message.dialogue, message.prompt, not self._silent)
        self._talk = Talk(
            Conversation(question.text, help_text(question.answers), time.monotonic),
            ears,
            lambda act: self._send(aloud.message(act)),
            over,
        )
        await self._talk.begin()

    async def _end(self, reason: EndReason) -> None:
        talk, self._talk = self._talk, None
        if talk is not None:
            await talk.end(reason)

    # --- to the helper ------------------------------------------------------------------------

    @property
    def _silent(self) -> bool:
        return isinstance(self._parts.speech.texts, NoVoice)

    async def _send(self, message: BaseModel) -> None:
        await self._websocket.send_text(message.model_dump_json())

    async def _refuse(
        self, status: int, detail: str, errors: list[str] | None = None, to: str | int | None = None
    ) -> None:
        refusal = problem(status, detail)
        await self._send(
            SpeechError(id=to, status=status, title=refusal.title, detail=detail, errors=errors)
        )


class Aloud:
    """How the acts of a conversation look on the wire, with the address of each sound."""

    def __init__(self, dialogue: UUID, prompt: UUID, audible: bool) -> None:
        base = f"/api/dialogues/{dialogue}/prompts/{prompt}/speech"
        self._audio = {
            Saying.QUESTION: base,
            Saying.HELP: f"{base}/help",
            Saying.SORRY: "/api/speech/phrases/sorry",
        }
        self._audible = audible

    def message(self, act: Act) -> BaseModel:
        match act:
            case talking.Say(what=what, text=text):
                return Say(what=what, text=text, audio=self._audio[what] if self._audible else None)
            case talking.Listen():
                return Listening()
            case talking.Hear():
                return Hearing()
            case talking.Understood(command=command, phrase=phrase, latency_s=latency_s):
                latency_ms = round(latency_s * 1000, 1)
                return HeardMessage(command=command, phrase=phrase, latency_ms=latency_ms)
            case talking.GiveUp():
                return GaveUp()
            case talking.End(reason=reason):
                return Ended(reason=reason)
