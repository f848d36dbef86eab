"""One run in a service of its own: begun, told as it goes on, and aborted by Ctrl-C."""

import asyncio
import signal
from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Protocol
from uuid import UUID

from mend.errors import ConflictError
from mend.server.cli.failures import INTERRUPTED, NOT_FINISHED, CommandLineError
from mend.server.cli.local_user import local_author
from mend.server.cli.output import EventOutput, JsonLines
from mend.server.cli.reports import write_run_report
from mend.server.cli.terminal_helper import TerminalHelper
from mend.server.journal import events as ev
from mend.server.journal.reader import JournalReader
from mend.server.journal.subscriptions import SubscriptionOverflowError
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.server.transcript import Transcript

if TYPE_CHECKING:
    from mend.server.composition import Service

ENDS = (ev.RunFinished, ev.RunFailed, ev.RunAborted)


class OpenService(Protocol):
    """Starts a service; `server.composition.open_service`."""

    def __call__(
        self, settings: Settings, *, recover: bool
    ) -> AbstractAsyncContextManager["Service"]: ...


class LiveRun:
    """Carries out one request and tells its events to an output."""

    def __init__(
        self,
        open_service: OpenService,
        settings: Settings,
        request: RunRequest,
        output: EventOutput,
        report: Path | None,
        *,
        asks_at_terminal: bool,
    ) -> None:
        self._open_service = open_service
        self._settings = settings
        self._request = request
        self._output = output
        self._report = report
        self._asks_at_terminal = asks_at_terminal
        self._interrupted = False
        self._last_words = ""

    async def carry_out(self) -> int:
        """Run it to its end and return the exit code.

        Raises `CommandLineError` and the errors of `server.errors`.
        """
        async with self._open_service(self._settings, recover=False) as service:
            before = service.journal.head
            run = (await service.runtime.start_run(self._request, local_author())).id
            status = await self._watch(service, run, before)
        self._output.close()
        if status is not RunStatus.FINISHED and isinstance(self._output, JsonLines):
            self._output.note(f"mend: {self._last_words}")
        self._write_report(run)
        if self._interrupted:
            return INTERRUPTED
        return 0 if status is RunStatus.FINISHED else NOT_FINISHED

    async def _watch(self, service: "Service", run: UUID, before: int) -> RunStatus:
        """Tell the run's events until its end; Ctrl-C aborts it."""
        aborting: list[asyncio.Task[None]] = []

        def interrupt() -> None:
            self._interrupted = True
            aborting.append(asyncio.create_task(_abort(service, run)))

        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, interrupt)
        ended = asyncio.create_task(service.runtime.wait_for_end(run))
        told = asyncio.create_task(self._tell(service, run, before))
        try:
            await asyncio.wait({ended, told}, return_when=asyncio.FIRST_COMPLETED)
            if not told.done() and not (await ended).status.ended:
                raise CommandLineError(
                    f"the run stopped for a fault of Mend's own; its journal is "
                    f"'{self._settings.journal_path}'",
                    NOT_FINISHED,
                )
            await told
            return (await ended).status
        finally:
            for task in (told, ended, *aborting):
                task.cancel()
            for number in (signal.SIGINT, signal.SIGTERM):
                loop.remove_signal_handler(number)

    async def _tell(self, service: "Service", run: UUID, before: int) -> None:
        helper = TerminalHelper(service.runtime, self._output) if self._asks_at_terminal else None
        with helper or nullcontext():
            async for event in _events_of(service, run, before):
                self._output.show(event)
                if helper is not None:
                    helper.take(event)
                if isinstance(event, ENDS):
                    self._last_words = Transcript().lines(event)[-1].text

    def _write_report(self, run: UUID) -> None:
        if self._report is None:
            return
        with JournalReader(self._settings.journal_path) as reader:
            write_run_report(self._report, reader.events(run), reader)
        self._output.note(f"report: {self._report}")


async def _abort(service: "Service", run: UUID) -> None:
    with suppress(ConflictError):
        await service.runtime.abort(run, local_author())


async def _events_of(service: "Service", run: UUID, after: int) -> AsyncIterator[ev.Event]:
    """The events of a run up to its end, from the journal as they are committed."""
    while True:
        try:
            with service.journal.subscribe(after) as subscription:
                async for record in subscription:
                    after = record.seq
                    event = ev.any_event.validate_json(record.text)
                    if event.run != run:
                        continue
                    yield event
                    if isinstance(event, ENDS):
                        return
                return
        except SubscriptionOverflowError:
            continue
