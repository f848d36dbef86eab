"""`mend` in processes of their own that have loaded it already.

Each is a fork of one process that has done nothing but load Mend, which takes longer than most of
what a test has a process for. In the benchmarks each begins anew, as a user's does.
"""

import asyncio
import gc
import os
import resource
import signal
import sys
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import wait as wait_for_any
from multiprocessing.context import ForkServerProcess
from multiprocessing.reduction import DupFd
from pathlib import Path
from threading import Lock
from typing import Any, Protocol

from sampled import sample

MEND = Path(sys.executable).with_name("mend")
FORKED = sample(True, False)
PATIENCE_S = 600.0
LOADED = (
    "__main__",
    "mend.server.cli.live_run",
    "mend.server.cli.other_service",
    "mend.server.cli.own_service",
    "mend.server.cli.run",
    "mend.server.cli.run_request",
    "mend.server.cli.serve",
    "mend.server.cli.shift",
    "mend.server.cli.site_names",
    "mend.server.composition",
    "mend.garbage",
    "mend.sim.building.adapter",
    "mend.sim.tabletop.tabletops",
    "mend.sim.workcell.adapter",
)
FORKS = get_context("forkserver")
FORKS.set_forkserver_preload(list(LOADED))


class MendProcess(Protocol):
    """What is known of a process, as asyncio has it."""

    @property
    def pid(self) -> int: ...

    @property
    def returncode(self) -> int | None: ...

    async def wait(self) -> int: ...

    def send_signal(self, signal: int) -> None: ...

    def terminate(self) -> None: ...

    def kill(self) -> None: ...


async def start_mend(
    *arguments: str,
    env: Mapping[str, str],
    stdout: int,
    stderr: int,
    descriptors: int | None = None,
    forked: bool = FORKED,
) -> MendProcess:
    """`mend` with these arguments and nothing on its stdin.

    `stdout` and `stderr` are descriptors, of which it gets its own; it may have only so many.
    """
    if not forked:
        return await asyncio.create_subprocess_exec(
            MEND, *arguments,
            env=env, stdin=asyncio.subprocess.DEVNULL, stdout=stdout, stderr=stderr,
            preexec_fn=None if descriptors is None else lambda: _bound(descriptors),
        )  # fmt: skip
    given = (_Given(stdout), _Given(stderr))
    process = FORKS.Process(target=_be_mend, args=(arguments, dict(env), given, descriptors))
    # The first of all waits until everything is loaded.
    await asyncio.to_thread(process.start)
    return Forked(process)


class Forked:
    """A process that is a fork."""

    def __init__(self, process: ForkServerProcess) -> None:
        self._process = process
        self._looking = Lock()

    @property
    def pid(self) -> int:
        assert self._process.pid is not None, "it was started"
        return self._process.pid

    @property
    def returncode(self) -> int | None:
        # Its code can be read once.
        with self._looking:
            return self._process.exitcode

    async def wait(self) -> int:
        while (code := self.returncode) is None:
            await asyncio.to_thread(wait_for_any, [self._process.sentinel], 1.0)
        return code

    def send_signal(self, signal: int) -> None:
        if self.returncode is None:
            os.kill(self.pid, signal)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)


@dataclass
class Command:
    """`mend` that goes on, and what it says."""

    process: MendProcess
    told: asyncio.StreamReader
    complaints: asyncio.StreamReader

    async def says(self, text: str) -> str:
        """Wait for a line with a text in it."""
        async for line in self.told:
            if text in line.decode():
                return line.decode()
        complaints = await self.complaints.read()
        raise AssertionError(f"it ended without saying '{text}': {complaints.decode()}")

    async def outcome(self) -> tuple[int, str, str]:
        """Its exit code, and what it said on stdout from now on and on stderr."""
        told, complaints = await asyncio.gather(self.told.read(), self.complaints.read())
        return await self.process.wait(), told.decode(), complaints.decode()


@asynccontextmanager
async def mend_command(*arguments: str, **environment: str) -> AsyncIterator[Command]:
    """A command that nobody at a terminal answers, with bounded patience, until the block ends."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MEND_")}
    (told, says), (complaints, complains) = os.pipe(), os.pipe()
    try:
        process = await start_mend(
            *arguments, env={**kept, **environment}, stdout=says, stderr=complains
        )
    finally:
        os.close(says)
        os.close(complains)
    command = Command(process, await _reader(told), await _reader(complaints))
    try:
        async with asyncio.timeout(PATIENCE_S):
            yield command
    finally:
        if process.returncode is None:
            process.kill()
        await command.outcome()


async def _reader(descriptor: int) -> asyncio.StreamReader:
    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), os.fdopen(descriptor, "rb")
    )
    return reader


class _Given:
    """A descriptor that is given to a fork."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def __reduce__(self) -> tuple[Any, ...]:
        # It can be given only now.
        return _taken, (DupFd(self._descriptor),)


def _taken(given: Any) -> int:
    return int(given.detach())


def _be_mend(
    arguments: tuple[str, ...],
    environment: dict[str, str],
    given: tuple[int, int],
    descriptors: int | None,
) -> None:
    """In the fork."""
    from mend.server.cli import main

    for number, descriptor in enumerate(given, start=1):
        os.dup2(descriptor, number)
        os.close(descriptor)
    # What is loaded is no garbage: looking through it takes long.
    gc.freeze()
    os.environ.clear()
    os.environ.update(environment)
    _bound(descriptors)
    sys.path[:0] = [each for each in environment.get("PYTHONPATH", "").split(os.pathsep) if each]
    sys.argv = [str(MEND), *arguments]
    main()


def _bound(descriptors: int | None) -> None:
    if descriptors is not None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (descriptors, descriptors))
