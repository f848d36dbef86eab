"""A helper who is spoken to: hears what is said and asked, and answers by voice."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from uuid import UUID

from mend.server.api.helper_messages import Error
from mend.server.api.speech_messages import (
    AnySpeechServerMessage,
    Ended,
    GaveUp,
    HeardMessage,
    Listening,
    Say,
)
from mend.server.cli.sound_device import SoundDevice
from mend.server.client import MendClient
from mend.server.client_errors import CommandRefusedError, RefusedError
from mend.server.client_speech import SpeechStream
from mend.server.client_stream import EventStream
from mend.server.journal.events import Answered, DialogueClosed, Prompt
from mend.server.runtime.views import Snapshot
from mend.server.speech.commands import Command


@dataclass(frozen=True, slots=True)
class Question:
    """An open question, and the run that it is about."""

    run: UUID
    dialogue: UUID
    prompt: UUID


@dataclass(frozen=True, slots=True)
class Statement:
    """Something that the robot says."""

    dialogue: UUID
    prompt: UUID
    text: str


class SpokenHelper:
    """Follows the runs of a service, one question or statement after the other.

    `tell` shows a line of text: everything that is spoken can also be read.
    """

    def __init__(
        self, client: MendClient, name: str, device: SoundDevice, tell: Callable[[str], None]
    ) -> None:
        self._client = client
        self._name = name
        self._device = device
        self._tell = tell
        self._waiting: asyncio.Queue[Question | Statement] = asyncio.Queue()
        self._over: set[UUID] = set()
        self._audible = False
        self._current: Question | None = None

    async def run(self) -> None:
        """Help until cancelled. Raises the errors of the client and of the sound device."""
        speech = await self._client.speech()
        self._audible = speech.voice.available
        if not speech.voice.available:
            self._tell(f"The service has no voice ({speech.voice.why_not}): read what it says.")
        if not speech.recognition.available:
            self._tell(f"The service hears nothing ({speech.recognition.why_not}).")
        async with self._client.follow(self._name) as stream, asyncio.TaskGroup() as tasks:
            tasks.create_task(self._attend(stream, speech.recognition.available))
            async for message in stream:
                self._take(message)

    def _take(self, message: object) -> None:
        """Take note of what is to be heard, and of what no longer is."""
        match message:
            case Snapshot(dialogues=dialogues):
                for each in dialogues:
                    if each.prompt is not None and each.awaiting == "answer":
                        self._wait_for(Question(each.run, each.dialogue, each.prompt.prompt))
            case Prompt(kind="ask"):
                self._wait_for(Question(message.run, message.dialogue, message.prompt))
            case Prompt():
                said = Statement(message.dialogue, message.prompt, message.text)
                self._waiting.put_nowait(said)
            case Answered(prompt=prompt, helper=helper, answer=answer):
                self._over.add(prompt)
                self._tell(f"{helper} has answered {answer}.")
            case DialogueClosed(reason=reason):
                self._tell(f"This dialogue is closed ({reason}).")

    def _wait_for(self, question: Question) -> None:
        # A question that is repeated while it is talked about needs no second conversation.
        if question != self._current:
            self._waiting.put_nowait(question)

    async def _attend(self, stream: EventStream, recognized: bool) -> None:
        while True:
            match await self._waiting.get():
                case Statement() as said:
                    await self._hear(said)
                case Question(prompt=prompt) as question if recognized and prompt not in self._over:
                    self._current = question
                    await self._talk_about(question, stream)
                    self._current = None

    async def _hear(self, said: Statement) -> None:
        self._tell(said.text)
        if self._audible:
            path = f"/api/dialogues/{said.dialogue}/prompts/{said.prompt}/speech"
            await self._play(path)

    async def _play(self, path: str) -> None:
        try:
            sound = await self._client.sound(path)
        except RefusedError as error:
            self._tell(f"That could not be spoken: {error}")
        else:
            await self._device.play(sound)

    async def _talk_about(self, question: Question, stream: EventStream) -> None:
        async with self._client.talk(self._name) as speech:
            sending = asyncio.create_task(self._send_sound(speech))
            try:
                await speech.listen(question.dialogue, question.prompt)
                async for message in speech:
                    if isinstance(message, Say):
                        await self._say(message, speech)
                    elif isinstance(message, HeardMessage):
                        await self._heard(message, question, stream)
                    elif self._is_last(message):
                        return
                    # A microphone that has failed would otherwise be waited for in vain.
                    if sending.done():
                        sending.result()
            finally:
                sending.cancel()
                # Whoever is told to stop meanwhile stops, too.
                (ended,) = await asyncio.gather(sending, return_exceptions=True)
                if isinstance(ended, Exception):
                    raise ended

    async def _send_sound(self, speech: SpeechStream) -> None:
        async for frame in self._device.microphone():
            await speech.sound(frame)

    async def _say(self, said: Say, speech: SpeechStream) -> None:
        self._tell(said.text)
        if said.audio is not None:
            await self._play(said.audio)
        await speech.spoken()

    async def _heard(self, heard: HeardMessage, question: Question, stream: EventStream) -> None:
        self._tell(f'You: "{heard.phrase}"' if heard.phrase else "You: (not understood)")
        try:
            match heard.command:
                case Command.YES:
                    await stream.answer(question.dialogue, question.prompt, "yes")
                case Command.NO:
                    await stream.answer(question.dialogue, question.prompt, "no")
                case Command.PLACE | Command.LEAVE_OUT | Command.NOT_NOW if heard.way is not None:
                    await stream.choose(question.dialogue, question.prompt, heard.way)
                case Command.STOP:
                    await self._client.pause(question.run)
                    self._tell("The run is paused.")
        except (CommandRefusedError, RefusedError) as error:
            self._tell(f"Too late: {error}.")

    def _is_last(self, message: AnySpeechServerMessage) -> bool:
        """Tell what a message means to the helper; whether the conversation is over with it."""
        match message:
            case Listening():
                self._tell("(listening)")
            case GaveUp():
                self._tell("I did not understand you. Please answer in the console.")
            case Error(detail=detail):
                self._tell(f"This question cannot be talked about: {detail}.")
        return isinstance(message, Ended | Error)
