"""The robot's end of the link: drives an agent, and keeps it connected to the service."""

import asyncio
import logging
import random
from collections import deque
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

from mend.robots.agent import AgentCore, ShowsPoses
from mend.robots.link.backoff import Backoff
from mend.robots.link.channel import Channel, ChannelClosedError
from mend.robots.link.clock import Clock
from mend.robots.link.command_memory import CommandMemory
from mend.robots.link.connection import Connection, UnknownCommand
from mend.robots.link.messages import Command, Hello, Picture, Rejected, ReportBody, Taken
from mend.robots.link.outbox import Outbox
from mend.robots.link.pacing import Pacer
from mend.robots.link.sampling import PoseSampling

log = logging.getLogger(__name__)

T = TypeVar("T")

Connect = Callable[[], Awaitable[Channel]]
"""Opens a channel. Raises `ChannelClosedError` (try again) or `LinkRefusedError` (give up)."""

Aside = Callable[[Callable[[], Any]], Awaitable[Any]]
"""Does something that takes a while where it keeps nobody waiting; one thing after the other."""

TURNS_OF_THE_LOOP = 5
"""So many turns of the event loop bring a frame from the socket to the agent."""


@dataclass(frozen=True, slots=True)
class LinkSettings:
    """How a robot reconnects, and how long it says goodbye."""

    first_backoff_s: float = 0.1
    longest_backoff_s: float = 2.0
    goodbye_s: float = 2.0


async def run_agent(
    agent: AgentCore,
    connect: Connect,
    outbox: Outbox,
    clock: Clock,
    generator: random.Random,
    settings: LinkSettings | None = None,
    aside: Aside | None = None,
) -> None:
    """Run a robot until it is told to shut down.

    With `aside` that has the agent at work, in a thread of its own for example, so that others in
    this event loop are not kept waiting. Raises `LinkRefusedError` if the service does not want it.
    """
    settings = settings or LinkSettings()
    await _RobotEnd(agent, connect, outbox, clock, generator, settings, aside or _at_once).run()


async def _at_once(work: Callable[[], Any]) -> Any:
    return work()


class _RobotEnd:
    def __init__(
        self,
        agent: AgentCore,
        connect: Connect,
        outbox: Outbox,
        clock: Clock,
        generator: random.Random,
        settings: LinkSettings,
        aside: Aside,
    ) -> None:
        self._agent = agent
        self._aside = aside
        self._emitted: list[Callable[[], None]] = []
        self._connect = connect
        self._outbox = outbox
        self._clock = clock
        self._settings = settings
        self._backoff = Backoff(
            generator, first_s=settings.first_backoff_s, longest_s=settings.longest_backoff_s
        )
        self._pacer = Pacer()
        self._memory = CommandMemory()
        self._commands: deque[Command | UnknownCommand] = deque()
        self._wake = asyncio.Event()
        self._connection: Connection | None = None
        self._simulated = False
        self._shown = agent if isinstance(agent, ShowsPoses) else None
        self._sampling = PoseSampling()

    async def run(self) -> None:
        self._agent.attach(self._emit, self._emit_picture)
        self._simulated = self._hello().simulated
        link = asyncio.create_task(self._stay_connected())
        pump = asyncio.create_task(self._pump())
        try:
            await asyncio.wait([link, pump], return_when=asyncio.FIRST_COMPLETED)
            for task in (link, pump):
                if task.done():
                    task.result()
        finally:
            for task in (link, pump):
                task.cancel()
            await asyncio.gather(link, pump, return_exceptions=True)

    def _hello(self) -> Hello:
        hello = self._agent.hello(self._outbox.boot)
        if self._shown is None:
            return hello
        return hello.model_copy(update={"shows": self._shown.pose_layout()})

    # --- What the agent emits -----------------------------------------------------------------

    async def _have_agent(self, work: Callable[[], T]) -> T:
        """Have the agent at work, and pass on what it emitted meanwhile."""
        try:
            result: T = await self._aside(work)
        finally:
            emitted, self._emitted = self._emitted, []
            for pass_on in emitted:
                pass_on()
        return result

    def _emit(self, body: ReportBody, time_s: float, world: dict[str, Any] | None) -> None:
        self._emitted.append(partial(self._report, body, time_s, world))

    def _report(self, body: ReportBody, time_s: float, world: dict[str, Any] | None) -> None:
        self._outbox.add(body, time_s, world)
        if self._connection is not None:
            self._connection.wake()

    def _emit_picture(self, picture: Picture) -> None:
        self._emitted.append(partial(self._show_picture, picture))

    def _show_picture(self, picture: Picture) -> None:
        if self._connection is not None:
            self._connection.send(picture)

    # --- The connection -----------------------------------------------------------------------

    async def _stay_connected(self) -> None:
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
            self._outbox,
            self._clock,
            self._agent.time_s,
            self._take,
            self._wake.set,
            self._show_poses,
        )

        def welcomed() -> None:
            self._connection = connection

        began = self._clock.now()
        try:
            await connection.run(self._hello(), welcomed)
        finally:
            # Two programs that both claim to be this robot end each other's connections at once:
            # only one that lasted counts as a success.
            if self._clock.now() - began > self._settings.longest_backoff_s:
                self._backoff.reset()

    def _take(self, command: Command | UnknownCommand) -> None:
        self._commands.append(command)
        self._wake.set()

    # --- Poses --------------------------------------------------------------------------------

    def _show_poses(self, rate_hz: float) -> None:
        self._sampling.ask(rate_hz)
        self._wake.set()

    def _show_if_due(self, *, at_rest: bool = False) -> None:
        if self._shown is None or self._connection is None:
            return
        due = self._sampling.due_at_rest if at_rest else self._sampling.due
        if due(self._agent.time_s(), self._clock.now()):
            self._connection.show(self._shown.poses())

    # --- The agent ----------------------------------------------------------------------------

    async def _pump(self) -> None:
        agent = self._agent
        while True:
            self._wake.clear()
            await self._carry_out_commands()
            if agent.shut_down:
                await self._say_goodbye()
                return
            if self._must_wait():
                self._show_if_due()
                await self._wake.wait()
                continue
            delay_s = self._pacer.delay_s(agent.pace, self._clock.now(), agent.time_s())
            if delay_s > 0.0:
                await self._clock.wait(self._wake, delay_s)
            elif await self._advance():
                self._show_if_due()
                await self._let_commands_in()
            else:
                self._show_if_due(at_rest=True)
                self._pacer.rest()
                await self._wake.wait()

    def _must_wait(self) -> bool:
        """Whether no time may pass before the service has taken what happened so far.

        A simulated world waits for its journal, so that it never is ahead of what it would be
        rebuilt from. A real robot goes on, until its outbox is crowded.
        """
        return len(self._outbox) > 0 if self._simulated else self._outbox.crowded

    async def _advance(self) -> bool:
        """Let a slice of time pass; False when there is nothing to do."""
        agent = self._agent
        longest_s = self._sampling.longest_slice_s(self._clock.now())
        slice_s = min(self._pacer.slice_s(agent.pace), longest_s)

        def advance() -> bool:
            began, robot_began = self._clock.now(), agent.time_s()
            busy = agent.advance(slice_s)
            self._pacer.took(self._clock.now() - began, agent.time_s() - robot_began)
            return busy

        return await self._have_agent(advance)

    async def _carry_out_commands(self) -> None:
        while self._commands:
            command = self._commands.popleft()
            if self._memory.is_new(command.id):
                if isinstance(command, UnknownCommand):
                    rejected = Rejected(command=command.id, reason=command.reason)
                    self._report(rejected, self._agent.time_s(), None)
                else:
                    await self._have_agent(partial(self._agent.handle, command.id, command.body))
                    self._sampling.change()
            if self._connection is not None:
                self._connection.send(Taken(command=command.id))

    async def _let_commands_in(self) -> None:
        for _ in range(TURNS_OF_THE_LOOP):
            await asyncio.sleep(0)

    async def _say_goodbye(self) -> None:
        """Deliver what is left, but do not wait for a service that is not there."""
        until = self._clock.now() + self._settings.goodbye_s
        while len(self._outbox) > 0 and self._connection is not None:
            left_s = until - self._clock.now()
            if left_s <= 0.0:
                return
            self._wake.clear()
            await self._clock.wait(self._wake, left_s)
        await self._let_commands_in()
