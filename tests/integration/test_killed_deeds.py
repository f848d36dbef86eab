"""`kill -9` of the real service right after an answer: what was answered is in the journal."""

import signal
from collections.abc import AsyncIterator
from pathlib import Path

import httpx
import pytest
from service_process import ServiceProcess, service_process
from service_under_test import TOKEN

from server.access.access import SESSION_COOKIE
from server.access.deeds import Deed, audit_of

pytestmark = pytest.mark.slow

SCENE = """\
name: bench
objects: {cup: {color: [1.0, 0.1, 0.1], size: [0.05, 0.05, 0.05], pose: {x: 0.5, y: -0.3}}}
places: {tray: {pose: {x: 0.5, y: 0.0}}}
"""


class Killed:
    """A service that is killed as soon as it has answered."""

    def __init__(self, service: ServiceProcess) -> None:
        self._service = service
        self.client = httpx.AsyncClient(
            base_url=service.url, headers={"Authorization": f"Bearer {TOKEN}"}, timeout=60
        )

    async def after(self, method: str, path: str, **more: object) -> list[Deed]:
        """The deeds in the journal's file after a request and the kill, before the next start."""
        answer = await self.client.request(method, path, **more)  # type: ignore[arg-type]
        self._service.send(signal.SIGKILL)
        assert answer.is_success, answer.text
        await self._service.process.wait()
        audit = audit_of(self._service.journal)
        assert audit.damage == []
        await self._service.start()
        return list(audit.deeds)


@pytest.fixture
async def killed(tmp_path: Path) -> AsyncIterator[Killed]:
    async with service_process(tmp_path, token=TOKEN) as service:
        killed = Killed(service)
        async with killed.client:
            yield killed


async def test_what_was_answered_is_in_the_journal_after_a_kill(killed: Killed) -> None:
    yaml = {"content-type": "application/yaml"}
    deeds = await killed.after("POST", "/api/scenes", content=SCENE, headers=yaml)
    assert deeds[-1].what == "uploaded the scene 'bench'"
    assert (await killed.client.get("/api/scenes/bench")).status_code == 200

    signed_in = await killed.client.post("/api/session", json={"token": TOKEN})
    cookie = {"Cookie": f"{SESSION_COOKIE}={signed_in.cookies[SESSION_COOKIE]}"}
    deeds = await killed.after("DELETE", "/api/session", headers=cookie)
    assert deeds[-1].what == "signed out"
    async with httpx.AsyncClient(base_url=killed.client.base_url, headers=cookie) as browser:
        assert (await browser.get("/api/session")).json()["signed_in"] is False

    nina = {"name": "nina", "role": "helper"}
    deeds = await killed.after("POST", "/api/access/principals", json=nina)
    assert (deeds[-1].deed, deeds[-1].who) == ("access_changed", "token")
    told = (await killed.client.get("/api/access/deeds")).json()["deeds"]
    assert [each["deed"] for each in told].count("access_changed") == 1
