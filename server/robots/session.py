"""One connection of one robot: reads, answers, and works its reports off in order."""

import asyncio
import logging
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Protocol

from pydantic import ValidationError

from mend.documents.plain_mistakes import what_it_must_be
from mend.errors import MendError, RefusalError
from mend.robots.link.channel import Channel, ChannelClosedError
from mend.robots.link.messages import (
    Ack,
    AnyRobotMessage,
    AnyServiceMessage,
    Hello,
    LinkError,
    Picture,
    Poses,
    Report,
    Taken,
    robot_message,
)
from mend.server.journal.journal import JournalClosedError
from mend.server.limits import LimitName
from mend.server.robots.silence import Silence
from mend.server.robots.times import LinkTimes

log = logging.getLogger(__name__)

ACK_AT_LEAST_EVERY = 32
WAITING_REPORTS = 256
WAITING_MESSAGES = 2048
LAST_WORD_S = 1.0


class MissingReportError(MendError):
    """A report came without its predecessor; the message says which."""


class TooManyReportsError(MendError):
    """A robot reports without end; the message says how much, `limit` which limit was reached."""

    def __init__(self, message: str, limit: LimitName) -> None:
        super().__init__(message)
        self.limit: LimitName = limit


class PictureError(MendError):
    """A picture that nobody can use; the message says why."""


class Receiver(Protocol):
    """Where a session takes what the robot sends."""

    async def receive_report(self, report: Report) -> Ack:
        """Commit a report unless it is known.

        Raises `MissingReportError` and `TooManyReportsError`.
        """
        ...

    def receive_taken(self, taken: Taken) -> None: ...

    def receive_poses(self, poses: Poses) -> None: ...

    def receive_picture(self, picture: Picture) -> None:
        """Raises `PictureError`."""
        ...

    def refuse(self, reason: str, limit: LimitName) -> None:
        """Have no more to do with this start of the robot's program; ends its connection."""
        ...


BEYOND_BOUNDS = frozenset(
    {
        "greater_than",
        "greater_than_equal",
        "less_than",
        "less_than_equal",
        "finite_number",
        "int_parsing_size",
    }
)
"""What pydantic calls a number that no robot means."""


class NoSenseError(MendError):
    """A message whose number is beyond all bounds: whoever sends it cannot be relied on."""


def read_message(text: str) -> AnyRobotMessage:
    """A robot's message. Raises `ValidationError`, or `NoSenseError` for a number beyond bounds."""
    try:
        return robot_message.validate_json(text)
    except ValidationError as error:
        if error.errors(include_url=False, include_input=False)[0]["type"] in BEYOND_BOUNDS:
            raise NoSenseError(sentence(error)) from error
        raise


def sentence(error: ValidationError) -> str:
    """What is wrong with a message, and where."""
    first = error.errors(include_url=False, include_input=False)[0]
    where = ".".join(str(each) for each in first["loc"])
    return (
        f"the message was not understood{f' at {where}' if where else ''}: {what_it_must_be(first)}"
    )


class RobotSession:
    """One connection after its hello. `last_heard` is the clock when something last came."""

    def __init__(
        self,
        channel: Channel,
        receiver: Receiver,
        clock: Callable[[], float],
        times: LinkTimes,
    ) -> None:
        self.last_heard = clock()
        self._channel = channel
        self._receiver = receiver
        self._clock = clock
        self._times = times
        self._silence = Silence(clock, times.heartbeat_s)
        self._outgoing: asyncio.Queue[AnyServiceMessage] = asyncio.Queue(WAITING_MESSAGES)
        self._work: asyncio.Queue[Report | Callable[[], Awaitable[None]]] = asyncio.Queue()
        self._room = asyncio.Semaphore(WAITING_REPORTS)
        self._owed: Ack | None = None
        self._owed_for = 0
        self._ending = asyncio.Event()
        self._ended = asyncio.Event()
        self._last_word = ""
        self.reason = "its connection was closed"

    @property
    def silent_s(self) -> float:
        """How long nothing has come, not counting when this service did not look."""
        return self._silence.so_far()

    def send(self, message: AnyServiceMessage) -> None:
        """Send a message after those that wait already; a robot that reads none is cut off."""
        try:
            self._outgoing.put_nowait(message)
        except asyncio.QueueFull:
            self.end_soon("the robot does not read what it is sent")

    def do(self, work: Callable[[], Awaitable[None]]) -> None:
        """Have something done between two reports."""
        self._work.put_nowait(work)

    def end_soon(self, reason: str) -> None:
        """End the connection, telling the robot why; a report under way is still committed."""
        if not self._ending.is_set():
            self.reason = self._last_word = reason
            self._ending.set()

    async def end(self, reason: str) -> None:
        """End the connection and wait until nothing of it is under way any more."""
        self.end_soon(reason)
        await self._ended.wait()

    async def run(self) -> None:
        """Serve the robot until its connection ends, for whatever reason."""
        worker = asyncio.create_task(self._work_off())
        others = [
            asyncio.create_task(each)
            for each in (self._read(), self._write(), self._watch(), self._wait_for_end())
        ]
        try:
            await asyncio.wait([worker, *others], return_when=asyncio.FIRST_COMPLETED)
            self._ending.set()
            self._work.put_nowait(_nothing)
            await self._finish(worker)
        finally:
            self._ending.set()
            for task in (worker, *others):
                task.cancel()
            results = await asyncio.gather(*others, return_exceptions=True)
            self._ended.set()
        for result in results:
            if isinstance(result, Exception):
                log.error("a robot's connection ended for a fault of ours", exc_info=result)
        await self._say_last_word()

    async def _finish(self, worker: asyncio.Task[None]) -> None:
        try:
            await worker
        except JournalClosedError:
            self._last_word = "the service is shutting down"
        except RefusalError as error:
            self._last_word = f"the report could not be committed: {error}"
        except Exception:
            log.exception("a robot's report could not be committed")
            self._last_word = "the service could not commit a report; send it again"

    async def _say_last_word(self) -> None:
        with suppress(ChannelClosedError, TimeoutError):
            async with asyncio.timeout(LAST_WORD_S):
                if self._last_word:
                    await self._channel.send(LinkError(detail=self._last_word).model_dump_json())

    async def _wait_for_end(self) -> None:
        await self._ending.wait()

    # --- Reading ------------------------------------------------------------------------------

    async def _read(self) -> None:
        with suppress(ChannelClosedError):
            while True:
                text = await self._channel.receive()
                self.last_heard = self._clock()
                self._silence.hear()
                try:
                    await self._take(read_message(text))
                except ValidationError as error:
                    self.send(LinkError(detail=sentence(error)))
                except NoSenseError as error:
                    self._receiver.refuse(str(error), "robot_numbers")
                    return

    async def _take(self, message: AnyRobotMessage) -> None:
        match message:
            case Report():
                await self._room.acquire()
                self._work.put_nowait(message)
            case Taken():
                self._receiver.receive_taken(message)
            case Picture():
                try:
                    self._receiver.receive_picture(message)
                except PictureError as error:
                    self.send(LinkError(detail=str(error)))
            case Poses():
                self._receiver.receive_poses(message)
            case Hello():
                self.send(LinkError(detail="a hello is only the first message of a connection"))

    async def _watch(self) -> None:
        """End when nothing comes any more, unless it is us who do not read."""
        silent_s = 0.0
        while silent_s <= self._times.silence_s:
            await asyncio.sleep(self._times.heartbeat_s)
            if self._room.locked():
                self._silence.hear()
            silent_s = self._silence.look()
        self.end_soon(f"nothing was heard of it for {silent_s:.1f} s")

    # --- Reports ------------------------------------------------------------------------------

    async def _work_off(self) -> None:
        while not self._ending.is_set():
            work = await self._work.get()
            if isinstance(work, Report):
                await self._commit(work)
                self._room.release()
            else:
                await work()
            if self._work.empty():
                self._acknowledge()

    async def _commit(self, report: Report) -> None:
        try:
            ack = await self._receiver.receive_report(report)
        except MissingReportError as error:
            self.send(LinkError(detail=str(error)))
            return
        except TooManyReportsError as error:
            self._receiver.refuse(str(error), error.limit)
            return
        if self._owed is not None and self._owed.boot != ack.boot:
            self._acknowledge()
        self._owed, self._owed_for = ack, self._owed_for + 1
        if self._owed_for >= ACK_AT_LEAST_EVERY:
            self._acknowledge()

    def _acknowledge(self) -> None:
        if self._owed is not None:
            self.send(self._owed)
        self._owed, self._owed_for = None, 0

    # --- Writing ------------------------------------------------------------------------------

    async def _write(self) -> None:
        with suppress(ChannelClosedError):
            while True:
                message = await self._outgoing.get()
                await self._channel.send(message.model_dump_json(exclude_none=True))


async def _nothing() -> None:
    return None
