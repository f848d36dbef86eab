"""Simulated worlds: each in a process of its own that is watched, or within this one."""

import asyncio
import logging
import os
import random
import signal
import sys
import time
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Protocol
from uuid import uuid4

from mend.errors import WrongInputError
from mend.robots.link.channel import Channel, memory_channel
from mend.robots.link.client import Aside, LinkedAgent, run_agents
from mend.robots.link.clock import LoopClock
from mend.robots.link.outbox import IN_MEMORY, Outbox
from mend.server.descriptors import (
    is_for_want_of_descriptors,
    once_there_are_descriptors,
    until_there_are_descriptors,
)
from mend.server.plain_text import plain
from mend.server.robots.passes import OwnRobots
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.silence import Silence
from mend.sim.robot_process import RobotProcessSetup, find_world
from mend.sim.world import WorldAdapter, WorldSetup, WorldUnavailableError
from mend.tasks.plugins import PluginError

log = logging.getLogger(__name__)

CHECK_S = 0.5

ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""A robot's matrices are small: more threads would only wait for each other."""


Ended = Callable[[str], None]
"""Told why, once, when a simulated world has ended without being stopped."""


class SimulatedWorld(Protocol):
    """A simulated world with its robots that this service runs."""

    @property
    def pid(self) -> int | None:
        """Its process, if it has one of its own and that is running."""
        ...

    async def start(self, setup: WorldSetup) -> None:
        """Start it, again if need be. Raises `WrongInputError` if its world cannot run here."""
        ...

    async def stop(self) -> None:
        """End it; nobody is told."""
        ...


async def launch(
    world_name: str,
    setup: WorldSetup,
    ended: Ended,
    *,
    registry: RobotRegistry,
    own_robots: OwnRobots,
    url: str,
    aside: Aside,
    certificate: Path | None = None,
    hang_s: float = 6.0,
) -> SimulatedWorld:
    """Start a world of the entry points, with its robots.

    A world in a process of its own that is silent for `hang_s` is killed; one in this process works
    `aside` of the event loop. `url` is this service's
    `/ws/robot`, as seen from this machine, and `certificate` the service's own, if it speaks TLS;
    the process gets a credential for its time. Raises `WrongInputError` if there is no such world
    or it cannot run here.
    """
    try:
        adapter = find_world(world_name)
    except (WorldUnavailableError, PluginError) as error:
        raise WrongInputError(str(error)) from error
    world: SimulatedWorld
    if adapter.own_process:
        world = WorldProcess(
            world_name, ended, registry, own_robots, url, certificate=certificate, hang_s=hang_s
        )
    else:
        world = InProcessWorld(adapter, ended, registry, own_robots, aside)
    await world.start(setup)
    return world


class WorldProcess:
    """A world in a child process; one that is silent for `hang_s` is killed.

    Until it has connected for the first time it has `start_s` to load its world. It is looked at
    every `check_s`; `clock` is any monotonic clock. While this process itself is stopped, or has no
    time to look, no robot is silent.
    """

    def __init__(
        self,
        world_name: str,
        ended: Ended,
        registry: RobotRegistry,
        own_robots: OwnRobots,
        url: str,
        *,
        certificate: Path | None = None,
        hang_s: float = 6.0,
        start_s: float = 120.0,
        stop_s: float = 2.0,
        check_s: float = CHECK_S,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._world_name = world_name
        self._ended = ended
        self._registry = registry
        self._url = url
        self._own_robots = own_robots
        self._tokens: list[str] = []
        self._certificate = None if certificate is None else str(certificate.resolve())
        self._hang_s = hang_s
        self._start_s = start_s
        self._stop_s = stop_s
        self._check_s = check_s
        self._clock = clock
        self._process: Process | None = None
        self._watcher: asyncio.Task[None] | None = None

    @property
    def pid(self) -> int | None:
        running = self._process is not None and self._process.returncode is None
        return self._process.pid if self._process is not None and running else None

    async def start(self, setup: WorldSetup) -> None:
        """Start the process, after ending the one there may be."""
        await self.stop()
        self._tokens = [self._own_robots.issue(each) for each in setup.robots]
        process = await once_there_are_descriptors(
            lambda: asyncio.create_subprocess_exec(
                sys.executable,
                "-P",
                "-m",
                "mend.sim.robot_process",
                stdin=PIPE,
                stdout=DEVNULL,
                stderr=PIPE,
                env=ONE_THREAD | os.environ,
            )
        )
        self._process = process
        self._watcher = asyncio.create_task(self._watch(process, setup.robots))
        told = RobotProcessSetup(
            world=self._world_name,
            setup=setup,
            url=self._url,
            tokens=self._tokens,
            certificate=self._certificate,
        )
        assert process.stdin is not None, "stdin is a pipe"
        process.stdin.write(told.model_dump_json().encode() + b"\n")
        # If it has died already, the watcher says so.
        with suppress(ConnectionError):
            await process.stdin.drain()

    async def stop(self) -> None:
        """End the process, by force if closing its stdin does not do it in time."""
        process, watcher = self._process, self._watcher
        self._process = self._watcher = None
        while self._tokens:
            self._own_robots.withdraw(self._tokens.pop())
        if process is None or watcher is None:
            return
        if watcher is not asyncio.current_task():
            watcher.cancel()
            await asyncio.gather(watcher, return_exceptions=True)
        assert process.stdin is not None, "stdin is a pipe"
        process.stdin.close()
        # Read to the end as well, as a pipe that was not is left open when the process has gone.
        try:
            async with asyncio.timeout(self._stop_s):
                await process.communicate()
        except TimeoutError:
            _kill(process)
            await process.wait()
            with suppress(TimeoutError):
                async with asyncio.timeout(self._stop_s):
                    await process.communicate()

    async def _watch(self, process: Process, robots: Sequence[str]) -> None:
        complaints = asyncio.create_task(_last_line(process))
        ended = asyncio.create_task(process.wait())
        try:
            hung = await self._wait_for_the_end(process, ended, robots)
            reason = hung or _how_it_ended(process.returncode, await complaints)
        finally:
            complaints.cancel()
            ended.cancel()
        log.warning("the process of %s is gone: %s", _named(robots), plain(reason))
        for robot in robots:
            await self._registry.end_connection(robot, reason)
        self._ended(reason)

    async def _wait_for_the_end(
        self, process: Process, ended: asyncio.Task[int], robots: Sequence[str]
    ) -> str | None:
        """Wait until the process has ended; says so if that was because it hung."""
        silence, patience_s = Silence(self._clock, self._check_s), self._start_s
        last_heard: float | None = None
        hung: str | None = None
        while not ended.done():
            await asyncio.wait([ended], timeout=self._check_s)
            times = [self._registry.last_heard(each) for each in robots]
            heard = max((each for each in times if each is not None), default=None)
            if heard is not None and heard != last_heard:
                last_heard, patience_s = heard, self._hang_s
                silence.hear()
            silent_s = silence.look()
            if hung is None and not ended.done() and silent_s > patience_s:
                hung = f"its process hung: nothing was heard of it for {silent_s:.1f} s"
                _kill(process)
        return hung


class InProcessWorld:
    """A world in the service's own process; for worlds that neither block for long nor crash."""

    def __init__(
        self,
        adapter: WorldAdapter,
        ended: Ended,
        registry: RobotRegistry,
        own_robots: OwnRobots,
        aside: Aside,
    ) -> None:
        self._aside = aside
        self._adapter = adapter
        self._ended = ended
        self._registry = registry
        self._own_robots = own_robots
        self._tokens: list[str] = []
        self._task: asyncio.Task[None] | None = None
        self._served: set[asyncio.Task[None]] = set()

    @property
    def pid(self) -> int | None:
        return None

    async def start(self, setup: WorldSetup) -> None:
        """Build the world and let the robot connect, after ending the one there may be."""
        await self.stop()
        # It needs none to come in, but nobody else is to come in under its name.
        self._tokens = [self._own_robots.issue(each) for each in setup.robots]
        self._task = asyncio.create_task(self._run(setup), name=_named(setup.robots))

    async def stop(self) -> None:
        task, self._task = self._task, None
        while self._tokens:
            self._own_robots.withdraw(self._tokens.pop())
        if task is not None and task is not asyncio.current_task():
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def _run(self, setup: WorldSetup) -> None:
        outboxes = [Outbox(IN_MEMORY, each, uuid4().hex) for each in setup.robots]
        reason = "it was shut down"
        try:
            # A world takes a while to build, for which nobody else should have to wait.
            group = await once_there_are_descriptors(
                lambda: asyncio.to_thread(self._adapter.create_agents, setup)
            )
            linked = [
                LinkedAgent(agent, self._connect, outbox)
                for agent, outbox in zip(group.agents, outboxes, strict=True)
            ]
            await run_agents(
                group, linked, LoopClock(), random.Random(setup.seed), aside=self._aside
            )
        except Exception as error:
            reason = f"its program failed: {error}"
            if is_for_want_of_descriptors(error):
                log.warning("the simulated %s begins anew: %s", _named(setup.robots), error)
                # Else it would only fail again, and that often is not tried.
                await until_there_are_descriptors()
            else:
                log.exception("the simulated %s failed", _named(setup.robots))
        finally:
            for outbox in outboxes:
                outbox.close()
        self._task = None
        for robot in setup.robots:
            await self._registry.end_connection(robot, reason)
        self._ended(reason)

    async def _connect(self) -> Channel:
        robot_end, service_end = memory_channel()
        task = asyncio.create_task(self._registry.serve(service_end))
        self._served.add(task)
        task.add_done_callback(self._served.discard)
        return robot_end


async def _last_line(process: Process) -> str:
    """What the process wrote to stderr last; reads on so that it never blocks on it."""
    assert process.stderr is not None, "stderr is a pipe"
    tail = b""
    while chunk := await process.stderr.read(4096):
        tail = (tail + chunk)[-4096:]
    lines = tail.decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else ""


def _named(robots: Sequence[str]) -> str:
    return f"robot{'s' * (len(robots) > 1)} {', '.join(robots)}"


def _how_it_ended(code: int | None, complaint: str) -> str:
    if code is not None and code < 0:
        return f"its process was ended by {signal.Signals(-code).name}"
    return f"its process ended with code {code}" + (f": {complaint}" if complaint else "")


def _kill(process: Process) -> None:
    with suppress(ProcessLookupError):
        process.kill()
