"""Ears that hear what a test tells them to, and a voice that any machine has."""

import asyncio
import io
import wave
from dataclasses import dataclass, field

from mend.server.speech.commands import Command
from mend.server.speech.ear import Ear, EarLostError, EarReport, TooManyConversationsError
from mend.server.speech.vocabulary import SpokenLanguage, Vocabulary
from mend.server.speech.voice import VoiceError


class ScriptedEar:
    """Implements `server.speech.ear.Ear`; hears an utterance at each word of `hears`.

    Sound whose first byte is 1 begins an utterance, and whose first byte is 2 ends it.
    """

    def __init__(self, hears: list[str | None], vocabulary: Vocabulary = Vocabulary.ANSWER) -> None:
        self._hears = hears
        self.vocabulary = vocabulary
        self._reports: asyncio.Queue[EarReport | EarLostError] = asyncio.Queue()
        self._interruptions = 0
        self.heard = b""
        self.gaps = 0
        self.closed = False

    def hear(self, pcm: bytes) -> None:
        self.heard += pcm
        if pcm[0] == 1:
            self._tell(EarReport(kind="began", interruptions=self._interruptions))
        elif pcm[0] == 2:
            self._tell(self._utterance(self._hears.pop(0)))

    def skip(self) -> None:
        self.gaps += 1

    def interrupt(self) -> None:
        self._interruptions += 1

    def lose(self) -> None:
        """Fail."""
        self._reports.put_nowait(EarLostError("the recognizer has ended"))

    async def report(self) -> EarReport:
        report = await self._reports.get()
        if isinstance(report, EarLostError):
            raise report
        return report

    async def close(self) -> None:
        self.closed = True

    def _tell(self, report: EarReport) -> None:
        self._reports.put_nowait(report)

    def _utterance(self, phrase: str | None) -> EarReport:
        return EarReport(
            kind="utterance",
            command=None if phrase in (None, "") else Command(phrase),
            phrase=phrase or None,
            words=phrase != "",
            latency_s=0.25,
            interruptions=self._interruptions,
        )


@dataclass
class ScriptedEars:
    """Implements `server.speech.ear.Ears`: a command's name, None for another, '' for noise."""

    hears: list[str | None] = field(default_factory=list)
    at_once: int = 8
    opened: list[ScriptedEar] = field(default_factory=list)
    engine: str = "scripted"
    language: SpokenLanguage = SpokenLanguage.ENGLISH

    def check_room(self) -> None:
        if sum(not ear.closed for ear in self.opened) >= self.at_once:
            raise TooManyConversationsError("too many spoken conversations are going on already")

    async def open(self, vocabulary: Vocabulary = Vocabulary.ANSWER) -> Ear:
        self.check_room()
        self.opened.append(ScriptedEar(self.hears, vocabulary=vocabulary))
        return self.opened[-1]

    async def close(self) -> None:
        """Nothing is kept."""


@dataclass
class ToneVoice:
    """Implements `server.speech.voice.Voice`: as many samples as the text has letters."""

    rendered: list[str] = field(default_factory=list)
    engine: str = "tone"
    broken: bool = False
    _changed: asyncio.Condition = field(default_factory=asyncio.Condition)

    async def has_rendered(self, count: int) -> None:
        """Wait until it has rendered so many texts."""
        async with self._changed:
            await self._changed.wait_for(lambda: len(self.rendered) >= count)

    async def render(self, text: str) -> bytes:
        if self.broken:
            raise VoiceError("tone failed")
        self.rendered.append(text)
        async with self._changed:
            self._changed.notify_all()
        written = io.BytesIO()
        with wave.open(written, "wb") as sound:
            sound.setnchannels(1)
            sound.setsampwidth(2)
            sound.setframerate(16_000)
            sound.writeframes(b"\0\1" * len(text))
        return written.getvalue()


FRAMES_AN_UTTERANCE = 25
"""Half a second of 20 ms frames."""


class MishearingEar(ScriptedEar):
    """Takes any half second of sound for an utterance, and understands none."""

    def __init__(self) -> None:
        super().__init__([])
        self._frames = 0

    def hear(self, pcm: bytes) -> None:
        self.heard += pcm
        self._frames += 1
        if self._frames % FRAMES_AN_UTTERANCE == 0:
            self._tell(EarReport(kind="began", interruptions=self._interruptions))
            self._tell(self._utterance(None))


@dataclass
class MishearingEars(ScriptedEars):
    """Ears to which nothing is a command."""

    async def open(self, vocabulary: Vocabulary = Vocabulary.ANSWER) -> Ear:  # noqa: ARG002
        self.check_room()
        self.opened.append(MishearingEar())
        return self.opened[-1]
