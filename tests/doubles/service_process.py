"""The real service as a process of its own, to be killed and started again."""

import asyncio
import os
import resource
import signal
import socket
import sys
import time
from collections.abc import AsyncIterator, Iterator, Sequence
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import psutil
from forked_mend import MendProcess, start_mend

from mend.server.client import MendClient
from mend.server.journal.reader import JournalReader

START_S = 60.0
"""Patience with a start, on a machine that is busy."""


MEND_SERVE = (str(Path(sys.executable).with_name("mend")), "serve")


class ServiceProcess:
    """`mend serve` on a port and a journal that stay the same over its lives.

    With `forked` each life is a fork of a process that has loaded Mend.
    """

    def __init__(
        self,
        folder: Path,
        *,
        descriptors: int | None = None,
        program: Sequence[str] = MEND_SERVE,
        token: str | None = None,
        forked: bool = False,
        **environment: str,
    ) -> None:
        self._forked = forked
        self._folder = folder
        self._descriptors = descriptors
        self._program = program
        self._token = token
        self._environment = environment
        self._port = free_port()
        self._process: MendProcess | None = None

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._port}"

    @property
    def port(self) -> int:
        return self._port

    @property
    def journal(self) -> Path:
        return self._folder / "journal.db"

    @property
    def complaints(self) -> str:
        """Everything that its lives wrote to stderr."""
        return (self._folder / "stderr").read_text()

    @property
    def process(self) -> MendProcess:
        """Its latest life."""
        assert self._process is not None, "it was started"
        return self._process

    async def start(self) -> None:
        """Start it; returns when it is ready."""
        await self.spawn()
        async with MendClient(self.url, token=self._token) as client:
            await client.wait_until_ready(START_S)

    async def spawn(self) -> None:
        """Start it; returns at once."""
        environment = {
            **{name: value for name, value in os.environ.items() if not name.startswith("MEND_")},
            "MEND_DATA_DIR": str(self._folder),
            "MEND_PORT": str(self._port),
            "MEND_LOG_LEVEL": "warning",
            # Nobody listens: a voice would say every prompt in a process of its own.
            "MEND_SPEECH_VOICE": "none",
            **({} if self._token is None else {"MEND_TOKEN": self._token}),
            **self._environment,
        }
        with self._outputs() as (nowhere, complaints):
            if self._forked:
                self._process = await start_mend(
                    "serve",
                    env=environment,
                    stdout=nowhere,
                    stderr=complaints,
                    descriptors=self._descriptors,
                )
                return
            self._process = await asyncio.create_subprocess_exec(
                *self._program, env=environment, stdout=nowhere, stderr=complaints
            )
            self._bound()

    @contextmanager
    def _outputs(self) -> Iterator[tuple[int, int]]:
        """The descriptors of its stdout and stderr."""
        complaining = (self._folder / "stderr").open("a")
        with Path(os.devnull).open("w") as nowhere, complaining as complaints:
            yield nowhere.fileno(), complaints.fileno()

    def _bound(self) -> None:
        """It may have only so many descriptors.

        Said from here: to say it in the new process all of this one would be copied first.
        """
        if self._descriptors is not None:
            most = (self._descriptors, self._descriptors)
            resource.prlimit(self.process.pid, resource.RLIMIT_NOFILE, most)

    async def kill(self) -> None:
        """`kill -9`; returns when it is gone, and its robots with it."""
        assert self._process is not None, "it was started"
        robots = self.robots()
        self._process.send_signal(signal.SIGKILL)
        await self._process.wait()
        orphans = await asyncio.to_thread(psutil.wait_procs, robots, timeout=10.0)
        assert orphans[1] == [], "a simulated robot outlived its service"

    def send(self, number: signal.Signals) -> None:
        """Send it a signal."""
        assert self._process is not None, "it was started"
        self._process.send_signal(number)

    async def stop(self) -> int | None:
        """Let it end by itself, if it still runs; its exit code."""
        if self._process is None:
            return None
        if self._process.returncode is None:
            self._process.terminate()
        return await self._process.wait()

    def robots(self) -> list[psutil.Process]:
        """The processes of its simulated robots."""
        assert self._process is not None, "it was started"
        return psutil.Process(self._process.pid).children()

    async def kill_robot(self, *, again: bool = False) -> bool:
        """`kill -9` its one robot, and with `again` the next one before it has connected.

        Returns False if there is none.
        """
        robots = self.robots()
        if not robots:
            return False
        robots[0].kill()
        if again:
            next_one = await self._next_robot(robots[0].pid)
            if next_one is not None:
                next_one.kill()
        return True

    async def _next_robot(self, last: int) -> psutil.Process | None:
        until = time.monotonic() + START_S
        while time.monotonic() < until:
            for robot in self.robots():
                if robot.pid != last:
                    return robot
            await asyncio.sleep(0.01)
        return None

    def head(self) -> int:
        """The last event in the journal, read from its file."""
        with JournalReader(self.journal) as reader:
            return max(
                (each.seq for run in reader.runs() for each in reader.events(run)), default=0
            )

    async def has_runs(self, count: int) -> None:
        """Wait until so many runs are in the journal."""
        async with asyncio.timeout(START_S):
            while self._runs() < count:  # noqa: ASYNC110 - the file tells nobody
                await asyncio.sleep(0.001)

    def _runs(self) -> int:
        with JournalReader(self.journal) as reader:
            return len(reader.runs())


@asynccontextmanager
async def service_process(
    folder: Path, *, descriptors: int | None = None, forked: bool = False, **environment: str
) -> AsyncIterator[ServiceProcess]:
    """A service that runs, until the end of the block; `environment` has more variables for it."""
    service = ServiceProcess(folder, descriptors=descriptors, forked=forked, **environment)
    await service.start()
    try:
        yield service
    finally:
        await service.stop()


def free_port() -> int:
    """A port of this machine that nobody has just now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
