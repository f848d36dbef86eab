"""One robot's end of the link: keeps it connected, and passes commands and reports on."""

import asyncio
import logging
import random
from collections import deque
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

from mend.robots.agent import Agent, Clockwork, Drives, ShowsPoses
from mend.robots.link.backoff import Backoff
from mend.robots.link.channel import Channel, ChannelClosedError
from mend.robots.link.clock import Clock
from mend.robots.link.command_memory import CommandMemory
from mend.robots.link.connection import Connection, UnknownCommand
from mend.robots.link.messages import (
    Command,
    Driven,
    Hello,
    Picture,
    Rejected,
    ReportBody,
    Taken,
)
from mend.robots.link.outbox import Outbox
from mend.robots.link.sampling import PoseSampling

log = logging.getLogger(__name__)

T = TypeVar("T")

Connect = Callable[[], Awaitable[Channel]]
"""Opens a channel. Raises `ChannelClosedError` (try again) or `LinkRefusedError` (give up)."""

Aside = Callable[[Callable[[], Any]], Awaitable[Any]]
"""Does something that takes a while where it keeps nobody waiting; one thing after the other."""


@dataclass(frozen=True, slots=True)
class LinkSettings:
    """How a robot reconnects, and how long it says goodbye."""

    first_backoff_s: float = 0.1
    longest_backoff_s: float = 2.0
    goodbye_s: float = 2.0


@dataclass(frozen=True, slots=True)
class LinkedAgent:
    """A robot, how it comes to the service, and where its reports wait."""

    agent: Agent
    connect: Connect
    outbox: Outbox


class RobotEnd:
    """What is between one robot and its connection."""

    def __init__(
        self,
        linked: LinkedAgent,
        clockwork: Clockwork,
        clock: Clock,
        generator: random.Random,
        settings: LinkSettings,
        wake: Callable[[], None],
    ) -> None:
        """`wake` is called when there is something for the robots to do."""
        self.outbox = linked.outbox
        self._agent = linked.agent
        self._connect = linked.connect
        self._clockwork = clockwork
        self._clock = clock
        self._settings = settings
        self._wake = wake
        self._backoff = Backoff(
            generator, first_s=settings.first_backoff_s, longest_s=settings.longest_backoff_s
        )
        self._memory = CommandMemory()
        self._commands: deque[Command | UnknownCommand] = deque()
        self._emitted: list[Callable[[], None]] = []
        self._connection: Connection | None = None
        self._shown = linked.agent if isinstance(linked.agent, ShowsPoses) else None
        self._drives = linked.agent if isinstance(linked.agent, Drives) else None
        self._sampling = PoseSampling()
        self._agent.attach(self._emit, self._emit_picture)

    @property
    def connected(self) -> bool:
        return self._connection is not None

    def hello(self) -> Hello:
        """What the robot is now, with what it shows and has driven."""
        hello = self._agent.hello(self.outbox.boot)
        hello = hello.model_copy(update={"driven": self._driven()})
        if self._shown is None:
            return hello
        return hello.model_copy(update={"shows": self._shown.pose_layout()})

    # --- What the agent emits -----------------------------------------------------------------

    def pass_on(self) -> None:
        """Pass on what the robot emitted since."""
        emitted, self._emitted = self._emitted, []
        for each in emitted:
            each()

    def _emit(self, body: ReportBody, time_s: float, world: dict[str, Any] | None) -> None:
        self._emitted.append(partial(self._report, body, time_s, world, self._driven()))

    def _driven(self) -> Driven | None:
        return None if self._drives is None else self._drives.driven()

    def _report(
        self,
        body: ReportBody,
        time_s: float,
        world: dict[str, Any] | None,
        driven: Driven | None = None,
    ) -> None:
        self.outbox.add(body, time_s, world, driven)
        if self._connection is not None:
            self._connection.wake()

    def _emit_picture(self, picture: Picture) -> None:
        self._emitted.append(partial(self._show_picture, picture))

    def _show_picture(self, picture: Picture) -> None:
        if self._connection is not None:
            self._connection.send(picture)

    # --- The connection -----------------------------------------------------------------------

    async def stay_connected(self) -> None:
        """Connect, and again whenever the connection ends.

        Raises `LinkRefusedError` if the service does not want the robot.
        """
        while True:
            with suppress(ChannelClosedError):
                channel = await self._connect()
                try:
                    await self._talk(channel)
                finally:
                    self._connection = None
                    self._sampling.ask(0.0)
                    with suppress(ChannelClosedError):
                        await channel.close()
            delay_s = self._backoff.next_s()
            log.info("not connected; trying again in %.1f s", delay_s)
            await self._clock.wait(asyncio.Event(), delay_s)

    async def _talk(self, channel: Channel) -> None:
        connection = Connection(
            channel,
            self.outbox,
            self._clock,
            self._clockwork.time_s,
            self._take,
            self._wake,
            self._show_poses,
        )

        def welcomed() -> None:
            self._connection = connection

        began = self._clock.now()
        try:
            await connection.run(self.hello(), welcomed)
        finally:
            # Two programs that both claim to be this robot end each other's connections at once:
            # only one that lasted counts as a success.
            if self._clock.now() - began > self._settings.longest_backoff_s:
                self._backoff.reset()

    def _take(self, command: Command | UnknownCommand) -> None:
        self._commands.append(command)
        self._wake()

    async def carry_out_commands(
        self, have_agents: Callable[[Callable[[], None]], Awaitable[None]]
    ) -> None:
        """Hand the robot what it was told; `have_agents` has it at work."""
        while self._commands:
            command = self._commands.popleft()
            if self._memory.is_new(command.id):
                if isinstance(command, UnknownCommand):
                    rejected = Rejected(command=command.id, reason=command.reason)
                    self._report(rejected, self._clockwork.time_s(), None)
                else:
                    await have_agents(partial(self._agent.handle, command.id, command.body))
                    self._sampling.change()
            if self._connection is not None:
                self._connection.send(Taken(command=command.id))

    # --- Poses --------------------------------------------------------------------------------

    def _show_poses(self, rate_hz: float) -> None:
        self._sampling.ask(rate_hz)
        self._wake()

    def longest_slice_s(self, now: float) -> float:
        """How much time may pass until poses are to be shown."""
        return self._sampling.longest_slice_s(now)

    def show_if_due(self, *, at_rest: bool = False) -> None:
        """Show where everything is, where somebody wants to see it now."""
        if self._shown is None or self._connection is None:
            return
        due = self._sampling.due_at_rest if at_rest else self._sampling.due
        if due(self._clockwork.time_s(), self._clock.now()):
            self._connection.show(self._shown.poses())
