"""The speech WebSocket: one helper's microphone, and the conversation that it is part of."""

import time

from fastapi import APIRouter
from pydantic import BaseModel
from starlette.websockets import WebSocket

from mend.errors import IllegalTransitionError, RefusalError
from mend.server.api.helper_connection import HelperConnection, HelperQuery
from mend.server.api.helper_messages import Auth
from mend.server.api.problem import problem
from mend.server.api.problems import count_refusal, problem_of
from mend.server.api.speech_messages import (
    AnySpeechClientMessage,
    Cancel,
    Ended,
    GaveUp,
    HeardMessage,
    Hearing,
    Listen,
    Listening,
    Say,
    Spoken,
    speech_client_message,
)
from mend.server.speech import conversation as talking
from mend.server.speech.chosen_way import way_meant
from mend.server.speech.conversation import Act, EndReason, Saying, SpokenConversation
from mend.server.speech.ear import NoEars
from mend.server.speech.phrases import FIXED, sorry_name
from mend.server.speech.question import Topic, open_topic, wait_until_over
from mend.server.speech.talk import Talk
from mend.server.speech.vocabulary import Vocabulary
from mend.server.speech.voice import NoVoice

router = APIRouter()

SPEECH_PATH = "/ws/speech"
MAX_MESSAGE_CHARS = 4 * 1024
MAX_SOUND_BYTES = 16 * 1024
"""Half a second."""


@router.websocket(SPEECH_PATH)
async def speech_socket(websocket: WebSocket) -> None:
    """Serve one helper's microphone until the connection ends."""
    await SpeechSocket(websocket).run()


class SpeechSocket(HelperConnection[HelperQuery]):
    """One helper's connection; at most one conversation at a time."""

    def __init__(self, websocket: WebSocket) -> None:
        super().__init__(SPEECH_PATH, websocket, HelperQuery, MAX_MESSAGE_CHARS)
        self._talk: Talk | None = None

    async def _serve(self, query: HelperQuery, helper: str) -> None:  # noqa: ARG002
        """Take messages and sound until the connection ends."""
        try:
            while True:
                received = await self._receive()
                if isinstance(received, bytes):
                    await self._take_sound(received)
                elif (message := await self._read(received, speech_client_message)) is not None:
                    await self._take_message(message)
        finally:
            if self._talk is not None:
                await self._talk.close()

    # --- from the helper ----------------------------------------------------------------------

    async def _take_sound(self, pcm: bytes) -> None:
        too_long = len(pcm) > MAX_SOUND_BYTES
        if too_long:
            self._parts.refusals.note("sound_bytes")
        if too_long or len(pcm) % 2:
            shape = f"frames of whole 16-bit samples, at most {MAX_SOUND_BYTES} bytes"
            await self._refuse(problem(413 if too_long else 422, f"sound comes in {shape}"))
        elif self._talk is not None:
            self._talk.hear(pcm)

    async def _take_message(self, message: AnySpeechClientMessage) -> None:
        try:
            await self._do(message)
        except IllegalTransitionError as error:
            await self._refuse(problem(409, str(error)), message.id)
        except RefusalError as error:
            refusal = problem_of(error)
            assert refusal is not None, "every refusal has a status"
            count_refusal(error, self._parts.refusals)
            await self._refuse(refusal, message.id)

    async def _do(self, message: AnySpeechClientMessage) -> None:
        match message:
            case Listen():
                await self._begin(message)
            case Spoken() if self._talk is not None:
                await self._talk.spoken()
            case Spoken():
                await self._refuse(problem(409, "there is no conversation"), message.id)
            case Cancel():
                await self._end(EndReason.CANCELLED)
            case Auth():
                pass

    async def _begin(self, message: Listen) -> None:
        ears = self._parts.speech.ears
        if isinstance(ears, NoEars):
            why_not = f"nothing can be recognized: {ears.why_not}"
            await self._refuse(problem(503, why_not), message.id)
            return
        topic = await open_topic(self._parts.runs, message.dialogue, message.prompt)
        await self._end(EndReason.REPLACED)
        ears.check_room()
        over = wait_until_over(
            self._parts.runs,
            self._parts.journal,
            message.dialogue,
            message.prompt,
            self._parts.settings.subscriber_queue,
        )
        promised = topic.vocabulary is Vocabulary.PROMISE
        sorry = sorry_name(ears.language, promised=promised)
        aloud = Aloud(message, topic, sorry, audible=not self._silent)
        self._talk = Talk(
            SpokenConversation(topic.text, topic.help_text, time.monotonic, FIXED[sorry]),
            ears,
            lambda act: self._send(aloud.message(act)),
            over,
            topic.vocabulary,
            topic.takes,
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


class Aloud:
    """How the acts of a conversation look on the wire, with the address of each sound."""

    def __init__(self, about: Listen, topic: Topic, sorry: str, *, audible: bool) -> None:
        base = f"/api/dialogues/{about.dialogue}/prompts/{about.prompt}/speech"
        promised = topic.vocabulary is Vocabulary.PROMISE
        self._ways = topic.ways
        fixed = "/api/speech/phrases"
        self._audio = {
            Saying.QUESTION: base,
            Saying.HELP: f"{fixed}/promise_help" if promised else f"{base}/help",
            Saying.SORRY: f"{fixed}/{sorry}",
        }
        self._audible = audible

    def message(self, act: Act) -> BaseModel:
        match act:
            case talking.SayAloud(what=what, text=text):
                return Say(what=what, text=text, audio=self._audio[what] if self._audible else None)
            case talking.StartListening():
                return Listening()
            case talking.Hear():
                return Hearing()
            case talking.Understood(command=command, phrase=phrase, latency_s=latency_s):
                latency_ms = round(latency_s * 1000, 1)
                way = way_meant(command, self._ways)
                return HeardMessage(command=command, phrase=phrase, latency_ms=latency_ms, way=way)
            case talking.StopTrying():
                return GaveUp()
            case talking.End(reason=reason):
                return Ended(reason=reason)
