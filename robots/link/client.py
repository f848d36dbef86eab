"""The robots' end of the link: drives agents, and keeps each connected to the service."""

import asyncio
import random
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from mend.robots.agent import AgentCore, Clockwork
from mend.robots.link.clock import Clock
from mend.robots.link.outbox import Outbox
from mend.robots.link.pacing import Pacer
from mend.robots.link.robot_end import Aside, Connect, LinkedAgent, LinkSettings, RobotEnd

__all__ = ["Aside", "Connect", "LinkSettings", "LinkedAgent", "run_agent", "run_agents"]

T = TypeVar("T")

TURNS_OF_THE_LOOP = 5
"""So many turns of the event loop bring a frame from the socket to the agent."""


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
    linked = [LinkedAgent(agent, connect, outbox)]
    await run_agents(agent, linked, clock, generator, settings, aside)


async def run_agents(
    clockwork: Clockwork,
    linked: Sequence[LinkedAgent],
    clock: Clock,
    generator: random.Random,
    settings: LinkSettings | None = None,
    aside: Aside | None = None,
) -> None:
    """Run robots that share a clock, each over a connection of its own, as `run_agent` does."""
    settings = settings or LinkSettings()
    await _Driver(clockwork, linked, clock, generator, settings, aside or _at_once).run()


async def _at_once(work: Callable[[], Any]) -> Any:
    return work()


class _Driver:
    """Lets time pass for the robots, as far as each of them may let it."""

    def __init__(
        self,
        clockwork: Clockwork,
        linked: Sequence[LinkedAgent],
        clock: Clock,
        generator: random.Random,
        settings: LinkSettings,
        aside: Aside,
    ) -> None:
        self._clockwork = clockwork
        self._clock = clock
        self._settings = settings
        self._aside = aside
        self._pacer = Pacer()
        self._wake = asyncio.Event()
        self._ends = [
            RobotEnd(each, clockwork, clock, generator, settings, self._wake.set) for each in linked
        ]
        self._simulated = any(each.hello().simulated for each in self._ends)

    async def run(self) -> None:
        tasks = [asyncio.create_task(each.stay_connected()) for each in self._ends]
        tasks.append(asyncio.create_task(self._pump()))
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in tasks:
                if task.done():
                    task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _pump(self) -> None:
        while True:
            self._wake.clear()
            for end in self._ends:
                await end.carry_out_commands(self._have_agents)
            if self._clockwork.shut_down:
                await self._say_goodbye()
                return
            if self._must_wait():
                self._show_if_due()
                await self._wake.wait()
                continue
            delay_s = self._pacer.delay_s(
                self._clockwork.pace, self._clock.now(), self._clockwork.time_s()
            )
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
        if self._simulated:
            return any(len(each.outbox) > 0 for each in self._ends)
        return any(each.outbox.crowded for each in self._ends)

    async def _have_agents(self, work: Callable[[], T]) -> T:
        """Have the agents at work, and pass on what they emitted meanwhile."""
        try:
            result: T = await self._aside(work)
        finally:
            for end in self._ends:
                end.pass_on()
        return result

    async def _advance(self) -> bool:
        """Let a slice of time pass; False when there is nothing to do."""
        now = self._clock.now()
        slice_s = min(
            self._pacer.slice_s(self._clockwork.pace),
            *(each.longest_slice_s(now) for each in self._ends),
        )

        def advance() -> bool:
            began, robot_began = self._clock.now(), self._clockwork.time_s()
            busy = self._clockwork.advance(slice_s)
            passed_s = self._clockwork.time_s() - robot_began
            self._pacer.took(self._clock.now() - began, passed_s)
            return busy

        return await self._have_agents(advance)

    def _show_if_due(self, *, at_rest: bool = False) -> None:
        for end in self._ends:
            end.show_if_due(at_rest=at_rest)

    async def _let_commands_in(self) -> None:
        for _ in range(TURNS_OF_THE_LOOP):
            await asyncio.sleep(0)

    async def _say_goodbye(self) -> None:
        """Deliver what is left, but do not wait for a service that is not there."""
        until = self._clock.now() + self._settings.goodbye_s
        while any(len(each.outbox) > 0 and each.connected for each in self._ends):
            left_s = until - self._clock.now()
            if left_s <= 0.0:
                return
            self._wake.clear()
            await self._clock.wait(self._wake, left_s)
        await self._let_commands_in()
