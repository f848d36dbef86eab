"""One connection of a robot to the service, from hello to the end."""

import asyncio
import json
import logging
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from pydantic import ValidationError

from mend.robots.link.channel import Channel, ChannelClosedError, LinkRefusedError
from mend.robots.link.clock import Clock
from mend.robots.link.messages import (
    Ack,
    AnyServiceMessage,
    Command,
    Heartbeat,
    Hello,
    LinkError,
    Picture,
    Poses,
    ShowPoses,
    Taken,
    Welcome,
    service_message,
)
from mend.robots.link.outbox import Outbox

log = logging.getLogger(__name__)

WELCOME_TIMEOUT_S = 10.0

WINDOW = 256
"""So many reports may be on their way without being acknowledged."""


@dataclass(frozen=True, slots=True)
class UnknownCommand:
    """A command that this robot cannot read: of a newer service, or malformed."""

    id: str
    reason: str


class Connection:
    """Delivers what is in the outbox, and passes commands on."""

    def __init__(
        self,
        channel: Channel,
        outbox: Outbox,
        clock: Clock,
        time_s: Callable[[], float],
        take: Callable[[Command | UnknownCommand], None],
        acknowledged: Callable[[], None],
        show_poses: Callable[[float], None],
    ) -> None:
        self._channel = channel
        self._outbox = outbox
        self._clock = clock
        self._time_s = time_s
        self._take = take
        self._acknowledged = acknowledged
        self._show_poses = show_poses
        self._wake_writer = asyncio.Event()
        self._over = asyncio.Event()
        self._unsaved: deque[Taken | Picture] = deque()
        self._poses: Poses | None = None
        self._sent_id = 0
        self._in_flight = 0

    def wake(self) -> None:
        """There is something new in the outbox."""
        self._wake_writer.set()

    def send(self, message: Taken | Picture) -> None:
        """Send a message that is lost with the connection."""
        self._unsaved.append(message)
        self.wake()

    def show(self, poses: Poses) -> None:
        """Send poses once the link has nothing better to do; newer ones take their place."""
        self._poses = poses
        self.wake()

    async def run(self, hello: Hello, welcomed: Callable[[], None]) -> None:
        """Talk until the connection ends.

        Raises `LinkRefusedError` if the service refuses the robot, `ChannelClosedError` at the end.
        """
        await self._channel.send(hello.model_dump_json(exclude_none=True))
        try:
            async with asyncio.timeout(WELCOME_TIMEOUT_S):
                welcome = await self._receive_welcome()
        except TimeoutError as error:
            raise ChannelClosedError("the service did not answer the hello") from error
        self._acknowledge(self._outbox.boot, welcome.received)
        welcomed()
        self.wake()
        tasks = [
            asyncio.create_task(each)
            for each in (self._read(), self._write(), self._beat(welcome.heartbeat_s))
        ]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._over.set()
            for task in tasks:
                task.cancel()
            results = await asyncio.gather(*tasks, return_exceptions=True)
        for result in results:
            if isinstance(result, Exception):
                raise result

    async def _receive_welcome(self) -> Welcome:
        while True:
            message = self._parse(await self._channel.receive())
            if isinstance(message, Welcome):
                return message
            if isinstance(message, LinkError):
                raise LinkRefusedError(message.detail)

    async def _read(self) -> None:
        while True:
            message = self._parse(await self._channel.receive())
            match message:
                case Command() | UnknownCommand():
                    self._take(message)
                case Ack():
                    self._acknowledge(message.boot or self._outbox.boot, message.seq)
                case ShowPoses():
                    self._show_poses(message.rate_hz)
                case LinkError():
                    log.warning("the service says: %s", message.detail)

    def _parse(self, text: str) -> AnyServiceMessage | UnknownCommand | None:
        try:
            return service_message.validate_json(text)
        except ValidationError as error:
            command_id = _command_id(text)
            if command_id is None:
                log.warning("a message of the service was not understood and is ignored")
                return None
            first = error.errors(include_url=False, include_input=False)[0]
            where = ".".join(str(each) for each in first["loc"])
            return UnknownCommand(command_id, f"the command was not understood: {where}")

    def _acknowledge(self, boot: str, seq: int) -> None:
        delivered = self._outbox.acknowledge(boot, seq)
        self._in_flight = max(0, self._in_flight - delivered)
        self._acknowledged()
        self.wake()

    async def _write(self) -> None:
        while True:
            await self._wake_writer.wait()
            self._wake_writer.clear()
            await self._write_what_there_is()

    async def _write_what_there_is(self) -> None:
        while True:
            while self._unsaved:
                await self._channel.send(self._unsaved.popleft().model_dump_json())
            stored = self._outbox.after(self._sent_id, 1) if self._in_flight < WINDOW else []
            if not stored:
                if self._poses is None:
                    return
                poses, self._poses = self._poses, None
                await self._channel.send(poses.model_dump_json())
                continue
            self._sent_id = stored[0].id
            self._in_flight += 1
            await self._channel.send(stored[0].text)

    async def _beat(self, heartbeat_s: float) -> None:
        while True:
            await self._clock.wait(self._over, heartbeat_s)
            await self._channel.send(Heartbeat(time=self._time_s()).model_dump_json())


def _command_id(text: str) -> str | None:
    """The id of what is a command, whatever else it is."""
    try:
        message = json.loads(text)
    except ValueError:
        return None
    if not isinstance(message, dict) or message.get("type") != "command":
        return None
    command_id = message.get("id")
    return command_id if isinstance(command_id, str) and 0 < len(command_id) <= 128 else None
