"""`kill -9` of the real service right after an answer: what was answered is in the journal."""

import asyncio
import signal
import sqlite3
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any

import httpx
import pytest
from forked_mend import FORKED
from service_process import ServiceProcess, service_process
from service_under_test import TOKEN

from mend.server.access.access import SESSION_COOKIE
from mend.server.access.deeds import Deed, audit_of

pytestmark = pytest.mark.slow

TREE = "{name: tidy, tree: {behavior: pick_and_place, object: cup, place: tray}}"
ROUNDS = 30
"""So many other requests are answered while nothing can be committed: there is time for a lie."""


class Killed:
    """A service that is killed as soon as it has answered."""

    def __init__(self, service: ServiceProcess) -> None:
        self._service = service
        self.client = httpx.AsyncClient(
            base_url=service.url, headers={"Authorization": f"Bearer {TOKEN}"}, timeout=60
        )

    async def after(self, method: str, path: str, **more: Any) -> Deed:
        """The last deed in the journal's file after a request, its answer and the kill."""
        with self._nothing_committed() as let_commit:
            asking = asyncio.create_task(self.client.request(method, path, **more))
            asking.add_done_callback(lambda _: self._service.send(signal.SIGKILL))
            await self._some_rounds(asking)
            let_commit()
            answer = await asking
            await self._service.process.wait()
        assert answer.is_success, answer.text
        audit = audit_of(self._service.journal)
        assert audit.damage == []
        return audit.deeds[-1]

    @contextmanager
    def _nothing_committed(self) -> Iterator[Callable[[], object]]:
        """While the service has to wait with each commit, until it is let."""
        with closing(sqlite3.connect(self._service.journal, isolation_level=None)) as other:
            other.execute("BEGIN IMMEDIATE")
            yield lambda: other.execute("ROLLBACK")

    async def _some_rounds(self, asking: "asyncio.Task[httpx.Response]") -> None:
        async with httpx.AsyncClient(base_url=self._service.url) as stranger:
            for _ in range(ROUNDS):
                if asking.done():
                    return
                with suppress(httpx.TransportError):
                    await stranger.get("/healthz")

    async def start(self) -> None:
        await self._service.start()


@pytest.fixture
async def killed(tmp_path: Path) -> AsyncIterator[Killed]:
    async with service_process(tmp_path, token=TOKEN, forked=FORKED) as service:
        killed = Killed(service)
        async with killed.client:
            yield killed


async def test_what_was_answered_is_in_the_journal_after_a_kill(killed: Killed) -> None:
    yaml = {"content-type": "application/yaml"}
    deed = await killed.after("POST", "/api/trees", content=TREE, headers=yaml)
    assert deed.what == "uploaded the tree 'tidy'"
    await killed.start()
    assert (await killed.client.get("/api/trees/tidy")).status_code == 200

    signed_in = await killed.client.post("/api/session", json={"token": TOKEN})
    cookie = {"Cookie": f"{SESSION_COOKIE}={signed_in.cookies[SESSION_COOKIE]}"}
    deed = await killed.after("DELETE", "/api/session", headers=cookie)
    assert deed.what == "signed out"
    await killed.start()
    async with httpx.AsyncClient(base_url=killed.client.base_url, headers=cookie) as browser:
        assert (await browser.get("/api/session")).json()["signed_in"] is False

    nina = {"name": "nina", "role": "helper"}
    deed = await killed.after("POST", "/api/access/principals", json=nina)
    assert (deed.deed, deed.who) == ("access_changed", "token")
