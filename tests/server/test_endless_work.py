"""What the service does again and again goes on, whatever one pass of it meets."""

import asyncio
import errno
import logging
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any, cast

import pytest

from mend.server.accepting import Acceptor
from mend.server.access.access import Access
from mend.server.access.deed_log import DeedLog
from mend.server.background import Endless
from mend.server.composition import _watch_access
from mend.server.limits import Limits
from mend.server.refusals import Refusals
from mend.server.visitors import Beyond, End, Visitor, Visitors

IN_TIME_S = 60.0


def test_what_fails_is_told_with_where_it_came_from_and_then_once_a_minute(
    caplog: pytest.LogCaptureFixture,
) -> None:
    now = 0.0
    work = Endless("sweeping", lambda: now)
    for _ in range(100):
        with work.one_pass():
            raise ValueError("no broom")
        now += 0.5
    assert caplog.messages == ["sweeping has failed and goes on (ValueError: no broom)"]
    assert "Traceback" in caplog.text
    assert caplog.records[0].levelno == logging.WARNING


async def test_who_ends_it_still_can() -> None:
    begun = asyncio.Event()

    async def work() -> None:
        with Endless("waiting").one_pass():
            begun.set()
            await asyncio.Event().wait()

    task = asyncio.create_task(work())
    await begun.wait()
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task


class Faulty(Visitors):
    """Whose `come` or `end_overdue` fails the first time."""

    def __init__(self, *, at: str) -> None:
        super().__init__(Limits(), Refusals(), lambda: 0.0)
        self._at: str | None = at
        self.looked = asyncio.Event()

    def come(self, address: str, end: End) -> Visitor | Beyond:
        self._may_fail("come")
        return super().come(address, end)

    def end_overdue(self) -> None:
        self._may_fail("end_overdue")
        self.looked.set()

    def _may_fail(self, at: str) -> None:
        if self._at == at:
            self._at = None
            raise RuntimeError("a fault of ours")


class Greeting(asyncio.Protocol):
    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        cast(asyncio.WriteTransport, transport).write(b"welcome")
        transport.close()


@asynccontextmanager
async def accepting(visitors: Visitors) -> AsyncIterator[tuple[str, int]]:
    """An acceptor that greets whoever comes; gives its address."""
    listening = socket.create_server(("127.0.0.1", 0))
    acceptor = Acceptor(listening, lambda _: Greeting(), visitors)
    acceptor.start(8)
    try:
        yield listening.getsockname()
    finally:
        acceptor.close()
        await acceptor.wait_closed()


async def test_a_connection_that_cannot_be_taken_is_closed_and_the_next_one_is_taken() -> None:
    async with accepting(Faulty(at="come")) as address, asyncio.timeout(IN_TIME_S):
        heard = []
        for _ in range(2):
            reader, writer = await asyncio.open_connection(*address)
            heard.append(await reader.read())
            writer.close()
    assert heard == [b"", b"welcome"]


async def test_overdue_connections_are_looked_for_again_after_a_fault() -> None:
    visitors = Faulty(at="end_overdue")
    async with accepting(visitors), asyncio.timeout(IN_TIME_S):
        await visitors.looked.wait()


async def test_what_keeps_one_look_at_who_may_come_in_from_being_made_keeps_no_other() -> None:
    seen: list[str] = []
    all_seen = asyncio.Event()

    class Pretended:
        principals = type("Principals", (), {"changes": ()})()

        def __getattr__(self, name: str) -> Callable[..., None]:
            def look(*_: Any) -> None:
                seen.append(name)
                if name == "take_changes":
                    all_seen.set()
                raise RuntimeError("a fault of ours")

            return look

    access, deeds = cast(Access, Pretended()), cast(DeedLog, Pretended())
    watching = asyncio.create_task(_watch_access(access, deeds, journal_changes=True))
    await asyncio.wait_for(all_seen.wait(), timeout=IN_TIME_S)
    assert seen == ["look", "let_go", "tell_due", "take_changes"]
    await asyncio.sleep(0)
    assert not watching.done()
    watching.cancel()


async def test_without_descriptors_it_is_not_tried_again_and_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tries = 0

    async def accept(_: socket.socket) -> Any:
        nonlocal tries
        tries += 1
        raise OSError(errno.EMFILE, "too many open files")

    monkeypatch.setattr("mend.server.accepting.TRY_AGAIN_S", 3600.0)
    monkeypatch.setattr(asyncio.get_running_loop(), "sock_accept", accept)
    async with accepting(Visitors(Limits(), Refusals(), lambda: 0.0)):
        for _ in range(100):
            await asyncio.sleep(0)
    assert tries == 1
