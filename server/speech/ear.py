"""The ear: a port for what a conversation listens with, and the child process behind it.

A decoder keeps Python's global lock while it works, so each conversation has a process.
"""

import asyncio
import logging
import struct
import sys
import time
from asyncio.subprocess import PIPE, Process
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Literal, Protocol, Self

from pydantic import BaseModel, ConfigDict

from mend.errors import MendError, UnavailableError
from mend.server.speech.commands import Command
from mend.server.speech.speech_model import SpeechModelError, find_speech_model
from mend.server.speech.vocabulary import SpokenLanguage, Vocabulary

log = logging.getLogger(__name__)

START_TIMEOUT_S = 40.0
MAX_BACKLOG_BYTES = 5 * 32_000
"""Five seconds of sound; an ear so far behind has lost the conversation."""

MOST_KEPT = 2
"""Each takes about 80 MB, and more for each vocabulary that it has heard with."""

HEADER = struct.Struct("<dI")
"""Before each piece of sound: when it came (monotonic seconds), and its bytes."""

BREAK = 0
"""Instead of a number of bytes: what came before does not belong to what comes next."""
GAP = 2**32 - 16
"""Instead of a number of bytes: sound is missing here."""
AFRESH: Mapping[Vocabulary, int] = {
    Vocabulary.ANSWER: 2**32 - 1,
    Vocabulary.PROMISE: 2**32 - 2,
    Vocabulary.WAYS: 2**32 - 3,
}
"""Instead of a number of bytes: another conversation begins with that vocabulary; it is `ready`
then."""


class EarLostError(MendError):
    """The ear has failed; the message is one sentence."""


class TooManyConversationsError(UnavailableError):
    """As many conversations as the service can take are going on."""


class EarReport(BaseModel):
    """What an ear tells of the sound that it was given.

    `words` says whether an utterance had any; `latency_s` counts from its last sound to this.
    `interruptions` is how many there had been before it.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    kind: Literal["ready", "began", "utterance"]
    command: Command | None = None
    phrase: str | None = None
    words: bool = False
    latency_s: float = 0.0
    interruptions: int = 0


class Ear(Protocol):
    """What one conversation listens with; never shared, as it adapts to voice and microphone."""

    def hear(self, pcm: bytes) -> None:
        """Take sound (PCM16, mono, 16 kHz), some at least."""
        ...

    def skip(self) -> None:
        """Sound is missing here: what is being said around it is no command."""
        ...

    def interrupt(self) -> None:
        """What was heard so far does not belong to what comes next."""
        ...

    async def report(self) -> EarReport:
        """Wait for what was heard. Raises `EarLostError`."""
        ...

    async def close(self) -> None: ...


class Ears(Protocol):
    """Where ears come from."""

    @property
    def language(self) -> SpokenLanguage: ...

    @property
    def engine(self) -> str: ...

    def check_room(self) -> None:
        """Raises `TooManyConversationsError` when there can be no further ear now."""
        ...

    async def open(self, vocabulary: Vocabulary = Vocabulary.ANSWER) -> Ear:
        """A new ear that is ready. Raises `TooManyConversationsError`, `EarLostError`."""
        ...

    async def close(self) -> None:
        """Let go of what is kept for later ears."""
        ...


@dataclass(frozen=True, slots=True)
class NoEars:
    """Nothing can be recognized; `why_not` is one sentence about it."""

    why_not: str
    language: SpokenLanguage = SpokenLanguage.ENGLISH


def choose_ears(
    wanted: bool,
    at_once: int,
    model: Path | None = None,
    language: SpokenLanguage = SpokenLanguage.ENGLISH,
) -> "ProcessEars | NoEars":
    """The ears that this installation has; those with a `model` of the operator's hear better."""
    if not wanted:
        return NoEars("the setting 'speech_recognition' is off")
    if language is not SpokenLanguage.ENGLISH and model is None:
        return NoEars(f"the setting 'speech_model' names no model of the language '{language}'")
    if language is SpokenLanguage.ENGLISH and find_spec("pocketsphinx") is None:
        return NoEars("pocketsphinx is not installed: pip install 'mend-robots[speech]'")
    try:
        if model is not None:
            find_speech_model(model)
    except SpeechModelError as error:
        return NoEars(str(error))
    return ProcessEars(at_once, model, language)


class ProcessEars:
    """Ears that are child processes, at most `at_once`.

    A few that are not needed any more are kept for the next conversations, which then need not
    wait for theirs.
    """

    def __init__(
        self,
        at_once: int,
        model: Path | None = None,
        language: SpokenLanguage = SpokenLanguage.ENGLISH,
    ) -> None:
        self._at_once = at_once
        self._language = language
        self._model = None if model is None else model.resolve()
        self._taken = 0
        self._kept: list[RecognizerProcess] = []
        self._closed = False

    @property
    def language(self) -> SpokenLanguage:
        return self._language

    @property
    def engine(self) -> str:
        if self._language is not SpokenLanguage.ENGLISH:
            return "moonshine"
        return "pocketsphinx" if self._model is None else "pocketsphinx and moonshine"

    def check_room(self) -> None:
        if self._taken >= self._at_once:
            raise TooManyConversationsError(
                f"{self._at_once} spoken conversations are going on already: answer by button"
            )

    async def open(self, vocabulary: Vocabulary = Vocabulary.ANSWER) -> Ear:
        self.check_room()
        self._taken += 1
        try:
            return ProcessEar(await self._ready_process(vocabulary), self._give_back)
        except BaseException:
            self._taken -= 1
            raise

    async def close(self) -> None:
        """End the processes that are kept, and keep none from now on."""
        self._closed = True
        kept, self._kept = self._kept, []
        for process in kept:
            await process.stop()

    async def _ready_process(self, vocabulary: Vocabulary) -> "RecognizerProcess":
        while self._kept:
            process = self._kept.pop()
            try:
                await process.begin_afresh(vocabulary)
            except EarLostError:
                log.warning("a recognizer that was kept has gone; another is started")
            else:
                return process
        return await RecognizerProcess.start(vocabulary, self._model, self._language)

    async def _give_back(self, process: "RecognizerProcess") -> None:
        self._taken -= 1
        if len(self._kept) < MOST_KEPT and process.runs and not self._closed:
            self._kept.append(process)
        else:
            await process.stop()


class ProcessEar:
    """An ear whose recognizer is a child process, until it is closed."""

    def __init__(
        self,
        process: "RecognizerProcess",
        give_back: Callable[["RecognizerProcess"], Awaitable[None]],
    ) -> None:
        self._process = process
        self._give_back: Callable[[RecognizerProcess], Awaitable[None]] | None = give_back
        self._skips = False

    def hear(self, pcm: bytes) -> None:
        if self._process.behind_bytes > MAX_BACKLOG_BYTES:
            # What comes now would be answered seconds late.
            self.skip()
        else:
            self._process.send(len(pcm), pcm)
            self._skips = False

    def skip(self) -> None:
        # Once is enough until there is sound again.
        if not self._skips:
            self._process.send(GAP)
            self._skips = True

    def interrupt(self) -> None:
        self._process.send(BREAK)

    async def report(self) -> EarReport:
        return await self._process.report()

    async def close(self) -> None:
        give_back, self._give_back = self._give_back, None
        if give_back is not None:
            await give_back(self._process)


class RecognizerProcess:
    """A recognizer in a child process, for one conversation after the other."""

    def __init__(self, process: Process) -> None:
        self._process = process
        assert process.stdin is not None
        assert process.stdout is not None
        self._to, self._from = process.stdin, process.stdout

    @classmethod
    async def start(
        cls,
        vocabulary: Vocabulary = Vocabulary.ANSWER,
        model: Path | None = None,
        language: SpokenLanguage = SpokenLanguage.ENGLISH,
    ) -> Self:
        """Start one; returns when it is ready. Raises `EarLostError`."""
        own_model = () if model is None else (str(model), language)
        process = await asyncio.create_subprocess_exec(
            # -P: nothing is imported from wherever the service was started.
            sys.executable, "-P", "-m", "mend.server.speech.ear_process", vocabulary,
            *own_model, stdin=PIPE, stdout=PIPE,
        )  # fmt: skip
        started = cls(process)
        await started._wait_until_ready()
        return started

    @property
    def runs(self) -> bool:
        return self._process.returncode is None

    @property
    def behind_bytes(self) -> int:
        """How much of what was sent it has not taken yet."""
        return self._to.transport.get_write_buffer_size()

    async def begin_afresh(self, vocabulary: Vocabulary) -> None:
        """Forget the conversation that it was part of. Raises `EarLostError`."""
        self.send(AFRESH[vocabulary])
        await self._wait_until_ready()

    def send(self, size: int, pcm: bytes = b"") -> None:
        # A child that has gone is found out by `report`.
        with suppress(OSError, RuntimeError):
            self._to.write(HEADER.pack(time.monotonic(), size) + pcm)

    async def report(self) -> EarReport:
        line = await self._from.readline()
        if not line:
            raise EarLostError("the recognizer has ended")
        return EarReport.model_validate_json(line)

    async def stop(self) -> None:
        if self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()
        await self._process.wait()

    async def _wait_until_ready(self) -> None:
        """Pass over what it still had to say about the conversation before."""
        try:
            async with asyncio.timeout(START_TIMEOUT_S):
                while (await self.report()).kind != "ready":
                    pass
        except BaseException as error:
            await self.stop()
            if isinstance(error, TimeoutError):
                raise EarLostError("the recognizer did not start in time") from None
            raise
