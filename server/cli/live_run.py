"""One run: begun, told as it goes on, and aborted by Ctrl-C."""

import asyncio
import signal
from contextlib import nullcontext
from pathlib import Path
from uuid import UUID

from mend.server.cli.failures import INTERRUPTED, NOT_FINISHED, CommandLineError
from mend.server.cli.output import EventOutput, JsonLines
from mend.server.cli.robots_to_come import RobotsToCome
from mend.server.cli.run_host import OpenHost, RunHost
from mend.server.cli.terminal_helper import TerminalHelper
from mend.server.client import ENDS
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.transcript import Transcript


class LiveRun:
    """Carries out one request and tells its events to an output."""

    def __init__(
        self,
        open_host: OpenHost,
        request: RunRequest,
        output: EventOutput,
        report: Path | None,
        *,
        asks_at_terminal: bool,
        wait_s: float,
    ) -> None:
        self._open_host = open_host
        self._request = request
        self._output = output
        self._report = report
        self._asks_at_terminal = asks_at_terminal
        self._wait_s = wait_s
        self._interrupted = False
        self._end: ev.Event | None = None

    async def carry_out(self) -> int:
        """Run it to its end and return the exit code.

        Raises `CommandLineError`, `OSError`, and the errors of `server.errors` and of the client.
        """
        async with self._open_host() as host:
            run = await RobotsToCome(host, self._output.note, self._wait_s).start(self._request)
            await self._watch(host, run)
            self._output.close()
            finished = isinstance(self._end, ev.RunFinished)
            if self._end is not None and not finished and isinstance(self._output, JsonLines):
                self._output.note(f"mend: {Transcript().lines(self._end)[-1].text}")
            if self._report is not None:
                await host.write_report(run, self._report)
                self._output.note(f"report: {self._report}")
        if self._interrupted:
            return INTERRUPTED
        return 0 if finished else NOT_FINISHED

    async def _watch(self, host: RunHost, run: UUID) -> None:
        """Tell the run's events until its end; Ctrl-C aborts it."""
        aborting: list[asyncio.Task[None]] = []

        def interrupt() -> None:
            self._interrupted = True
            aborting.append(asyncio.create_task(host.abort(run)))

        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, interrupt)
        stopped = asyncio.create_task(host.stopped(run))
        told = asyncio.create_task(self._tell(host, run))
        try:
            await asyncio.wait({stopped, told}, return_when=asyncio.FIRST_COMPLETED)
            if not told.done():
                await stopped
                raise CommandLineError(
                    f"the run stopped for a fault of Mend's own; {host.journal}", NOT_FINISHED
                )
            await told
        finally:
            for task in (told, stopped, *aborting):
                task.cancel()
            for number in (signal.SIGINT, signal.SIGTERM):
                loop.remove_signal_handler(number)

    async def _tell(self, host: RunHost, run: UUID) -> None:
        helper = TerminalHelper(host.answer, self._output) if self._asks_at_terminal else None
        with helper or nullcontext():
            async for event in host.events(run):
                self._output.show(event)
                if helper is not None:
                    helper.take(event)
                if isinstance(event, ENDS):
                    self._end = event
                    return
