"""A service of `mend run`'s own: begun for one run, and ended with it."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Protocol
from uuid import UUID

from mend.errors import ConflictError
from mend.server.cli.failures import CommandLineError
from mend.server.cli.local_user import local_author
from mend.server.cli.reports import write_run_report
from mend.server.fixed_documents import GivenFiles
from mend.server.journal import events as ev
from mend.server.journal.reader import JournalReader
from mend.server.journal.subscriptions import SubscriptionOverflowError
from mend.server.listening import CannotListenError
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RobotView
from mend.server.settings import Settings

if TYPE_CHECKING:
    from mend.server.composition import Service


class OpenService(Protocol):
    """Starts a service; `server.composition.open_service`."""

    def __call__(
        self, settings: Settings, *, recover: bool, given: GivenFiles
    ) -> AbstractAsyncContextManager["Service"]: ...


@asynccontextmanager
async def own_service(
    open_service: OpenService, settings: Settings, given: GivenFiles
) -> AsyncIterator["OwnService"]:
    """Have a service for one run. Raises what `open_service` does, and `CommandLineError`."""
    try:
        async with open_service(settings, recover=False, given=given) as service:
            yield OwnService(service)
    except CannotListenError as error:
        raise CommandLineError(
            f"{error}; if it is a Mend service that listens there, give its address with --url"
        ) from error


class OwnService:
    """Implements `mend.server.cli.run_host.RunHost`."""

    def __init__(self, service: "Service") -> None:
        self._service = service
        self._runtime = service.runtime
        self._before = 0

    @property
    def door(self) -> str:
        return self._service.robots_url

    @property
    def journal(self) -> str:
        return f"its journal is '{self._service.settings.journal_path}'"

    async def robots(self) -> list[RobotView]:
        return self._runtime.robots()

    async def start(self, request: RunRequest) -> UUID:
        self._before = self._service.journal.head
        return (await self._runtime.start_run(request, local_author())).id

    async def events(self, run: UUID) -> AsyncIterator[ev.Event]:
        after = self._before
        while True:
            with (
                suppress(SubscriptionOverflowError),
                self._service.journal.subscribe(after) as subscription,
            ):
                async for record in subscription:
                    after = record.seq
                    event = ev.any_event.validate_json(record.text)
                    if event.run == run:
                        yield event
                return

    async def stopped(self, run: UUID) -> None:
        if (await self._runtime.wait_for_end(run)).status.ended:
            await asyncio.Event().wait()

    async def answer(
        self, dialogue: UUID, prompt: UUID, answer: Literal["yes", "no"], helper: str
    ) -> object:
        return await self._runtime.dialogues.answer(dialogue, prompt, answer, helper)

    async def abort(self, run: UUID) -> None:
        with suppress(ConflictError):
            await self._runtime.abort(run, local_author())

    async def write_report(self, run: UUID, path: Path) -> None:
        with JournalReader(self._service.settings.journal_path) as reader:
            write_run_report(path, reader.events(run), reader)
