"""A service that was there before `mend run`, and carries out its run."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Literal
from uuid import UUID

from mend.errors import ConflictError
from mend.server.cli.local_user import local_user
from mend.server.cli.site_names import find_site
from mend.server.client import MendClient
from mend.server.client_errors import RefusedError
from mend.server.documents import DocumentKind
from mend.server.errors import NotConnectedError
from mend.server.fixed_documents import GivenFiles
from mend.server.journal import events as ev
from mend.server.report.page import write_report
from mend.server.robots.address import robots_url
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RobotView, Snapshot

CONFLICT = 409


@asynccontextmanager
async def other_service(
    url: str, token: str | None, given: GivenFiles, site: str | None = None
) -> AsyncIterator["OtherService"]:
    """Have the service at an address do a run; the files given for it are uploaded first.

    `site`: what somebody calls the one where it is to be. Raises `CommandLineError` if there is
    none.
    """
    async with MendClient(url, token=token) as client:
        uploads = {
            DocumentKind.SCENE: client.upload_scene,
            DocumentKind.TREE: client.upload_tree,
            DocumentKind.SCENARIO: client.upload_scenario,
        }
        # A tree is checked in its scene, and a scenario against its tree.
        for kind, upload in uploads.items():
            for name, text in given.texts.get(kind, {}).items():
                await upload(text, name)
        at = None if site is None else (await find_site(client, site)).id
        yield OtherService(client, url.rstrip("/"), at)


class OtherService:
    """Implements `mend.server.cli.run_host.RunHost`; every method raises the client's errors."""

    def __init__(self, client: MendClient, url: str, site: UUID | None) -> None:
        self._client = client
        self._url = url
        self._site = site

    @property
    def door(self) -> str:
        return robots_url(self._url)

    @property
    def journal(self) -> str:
        return f"the journal of the service at {self._url} has more"

    async def robots(self) -> list[RobotView]:
        return await self._client.robots()

    async def start(self, request: RunRequest) -> UUID:
        request = request.model_copy(update={"site": self._site})
        try:
            return (await self._client.start_run(request)).id
        except RefusedError as error:
            if error.problem.not_connected is None:
                raise
            raise NotConnectedError(str(error), error.problem.not_connected) from error

    async def events(self, run: UUID) -> AsyncIterator[ev.Event]:
        seen = 0
        async with self._client.follow(local_user()) as stream:
            async for message in stream:
                if isinstance(message, Snapshot):
                    # The first one, or one after events that were missed: both are read there.
                    async for event in self._past_events(run, seen):
                        seen = event.seq
                        yield event
                elif message.run == run and message.seq > seen:
                    seen = message.seq
                    yield message

    async def _past_events(self, run: UUID, after: int) -> AsyncIterator[ev.Event]:
        while page := await self._client.events(run, after=after, limit=1000):
            for event in page:
                yield event
            after = page[-1].seq

    async def stopped(self, run: UUID) -> None:  # noqa: ARG002
        """Only the service itself learns of that, and whoever starts it again has it go on."""
        await asyncio.Event().wait()

    async def answer(
        self, dialogue: UUID, prompt: UUID, answer: Literal["yes", "no"], helper: str
    ) -> object:
        try:
            return await self._client.answer(dialogue, prompt, answer, helper)
        except RefusedError as error:
            raise ConflictError(str(error)) from error

    async def abort(self, run: UUID) -> None:
        try:
            await self._client.abort(run)
        except RefusedError as error:
            if error.problem.status != CONFLICT:
                raise

    async def write_report(self, run: UUID, path: Path) -> None:
        events = [each async for each in self._past_events(run, 0)]
        wanted = [each.picture for each in events if isinstance(each, ev.IssueRaised)]
        pictures = {each: await self._client.picture(each) for each in wanted if each is not None}
        write_report(path, events, pictures)
