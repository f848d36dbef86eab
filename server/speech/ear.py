"""The ear: a port for what a conversation listens with, and the child process behind it.

PocketSphinx keeps Python's global lock while it decodes, so each conversation has a process.
"""

import asyncio
import struct
import sys
import time
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Literal, Protocol, Self

from pydantic import BaseModel, ConfigDict

from server.errors import ServiceError
from server.speech.commands import Command

START_TIMEOUT_S = 20.0
MAX_BACKLOG_BYTES = 5 * 32_000
"""Five seconds of sound; an ear so far behind has lost the conversation."""

HEADER = struct.Struct("<dI")
"""Before each piece of sound: when it came (monotonic seconds), and its bytes; 0 for a break."""


class EarLostError(Exception):
    """The ear has failed; the message is one sentence."""


class TooManyConversationsError(ServiceError):
    """As many conversations as the service can take are going on."""


class Report(BaseModel):
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
        """Take sound (PCM16, mono, 16 kHz)."""
        ...

    def interrupt(self) -> None:
        """What was heard so far does not belong to what comes next."""
        ...

    async def report(self) -> Report:
        """Wait for what was heard. Raises `EarLostError`."""
        ...

    async def close(self) -> None: ...


class Ears(Protocol):
    """Where ears come from."""

    @property
    def engine(self) -> str: ...

    def check_room(self) -> None:
        """Raises `TooManyConversationsError` when there can be no further ear now."""
        ...

    async def open(self) -> Ear:
        """A new ear that is ready. Raises `TooManyConversationsError`, `EarLostError`."""
        ...


@dataclass(frozen=True, slots=True)
class NoEars:
    """Nothing can be recognized; `why_not` is one sentence about it."""

    why_not: str


def choose_ears(wanted: bool, at_once: int) -> "ProcessEars | NoEars":
    """The ears that this installation has."""
    if not wanted:
        return NoEars("the setting 'speech_recognition' is off")
    if find_spec("pocketsphinx") is None:
        return NoEars("pocketsphinx is not installed: pip install 'mend[speech]'")
    return ProcessEars(at_once)


class ProcessEars:
    """Ears that are child processes, at most `at_once`."""

    engine = "pocketsphinx"

    def __init__(self, at_once: int) -> None:
        self._at_once = at_once
        self._taken = 0

    def check_room(self) -> None:
        if self._taken >= self._at_once:
            raise TooManyConversationsError(
                f"{self._at_once} spoken conversations are going on already: answer by button"
            )

    async def open(self) -> Ear:
        self.check_room()
        self._taken += 1
        try:
            return await ProcessEar.start(self._give_back)
        except BaseException:
            self._give_back()
            raise

    def _give_back(self) -> None:
        self._taken -= 1


class ProcessEar:
    """A recognizer in a child process."""

    def __init__(self, process: Process, closed: Callable[[], None]) -> None:
        self._process = process
        self._closed: Callable[[], None] | None = closed
        assert process.stdin is not None
        assert process.stdout is not None
        self._to, self._from = process.stdin, process.stdout

    @classmethod
    async def start(cls, closed: Callable[[], None]) -> Self:
        """Start one; returns when it is ready. `closed` is called once it is closed."""
        process = await asyncio.create_subprocess_exec(
            # -P: nothing is imported from wherever the service was started.
            sys.executable, "-P", "-m", "server.speech.ear_process",
            stdin=PIPE, stdout=PIPE,
        )  # fmt: skip
        ear = cls(process, closed)
        try:
            async with asyncio.timeout(START_TIMEOUT_S):
                await ear.report()
        except BaseException as error:
            await ear._stop()
            if isinstance(error, TimeoutError):
                raise EarLostError("the recognizer did not start in time") from None
            raise
        return ear

    def hear(self, pcm: bytes) -> None:
        if self._to.transport.get_write_buffer_size() > MAX_BACKLOG_BYTES:
            # What comes now would be answered seconds late; the gap makes it no command.
            return
        self._send(pcm)

    def interrupt(self) -> None:
        self._send(b"")

    async def report(self) -> Report:
        line = await self._from.readline()
        if not line:
            raise EarLostError("the recognizer has ended")
        return Report.model_validate_json(line)

    async def close(self) -> None:
        if self._closed is not None:
            closed, self._closed = self._closed, None
            try:
                await self._stop()
            finally:
                closed()

    def _send(self, pcm: bytes) -> None:
        # A child that has gone is found out by `report`.
        with suppress(OSError, RuntimeError):
            self._to.write(HEADER.pack(time.monotonic(), len(pcm)) + pcm)

    async def _stop(self) -> None:
        if self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()
        await self._process.wait()
