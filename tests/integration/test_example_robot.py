"""The example robot, as a user runs it, against the real endpoint."""

import asyncio
import time
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from example_robot import TOKEN, example_robot
from loopback import served
from recording_sink import RecordingSink
from service_process import free_port

from mend.robots.link.messages import Interrupt, Location, Look, Looked, Resume, Start
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.registry import RobotRegistry

pytestmark = pytest.mark.slow


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


def start(execution: str) -> Start:
    return Start(
        execution=execution,
        node="/0",
        behavior="pick_and_place",
        parameters={"object": "green_leg", "place": "green_leg"},
        target=Location(x=0.46, y=-0.05),
    )


def looks(sink: RecordingSink) -> list[Looked]:
    return [each.body for each in sink.reports if isinstance(each.body, Looked)]


async def test_it_places_a_part_and_sees_it_there(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    sink = RecordingSink(journal)
    registry.assign("demo", sink)
    async with served(registry, TOKEN) as url, example_robot(url):
        await sink.wait_until(lambda: len(sink.hellos) == 1)
        at_place = Look(object="green_leg", place="green_leg", expect="at_place")
        registry.send("demo", "c1", at_place)
        registry.send("demo", "c2", start("e1"))
        await sink.wait_until(lambda: "finished" in sink.types())
        registry.send("demo", "c3", at_place)
        await sink.wait_until(lambda: len(looks(sink)) == 2)
    before, after = looks(sink)
    assert (before.fulfilled, after.fulfilled) == (False, True)
    assert (after.objects["green_leg"].x, after.objects["green_leg"].y) == (0.46, -0.05)
    assert sink.types() == ["looked", *["step_started"] * 8, "finished", "looked"]


async def test_it_holds_resumes_and_rejects(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    sink = RecordingSink(journal)
    registry.assign("demo", sink)
    async with served(registry, TOKEN) as url, example_robot(url, "--step-s", "0.05"):
        await sink.wait_until(lambda: len(sink.hellos) == 1)
        registry.send("demo", "c1", start("e1"))
        await sink.wait_until(lambda: len(sink.reports) >= 2)
        registry.send("demo", "c2", start("e2"))
        registry.send("demo", "c3", Interrupt(retreat=False))
        await sink.wait_until(lambda: "holding" in sink.types())
        registry.send("demo", "c4", Resume(execution="e1"))
        await sink.wait_until(lambda: "finished" in sink.types())
    assert sink.types().count("rejected") == 1
    assert sink.types().index("holding") + 1 == sink.types().index("resumed")


async def test_it_goes_on_after_the_service_was_away_and_delivers_what_happened_meanwhile(
    journal: SqliteJournal,
) -> None:
    async with AsyncExitStack() as robot:
        registry = RobotRegistry(journal, time.monotonic)
        before = RecordingSink(journal)
        registry.assign("demo", before)
        async with served(registry, TOKEN) as url:
            await robot.enter_async_context(example_robot(url, "--step-s", "0.05"))
            await before.wait_until(lambda: len(before.hellos) == 1)
            registry.send("demo", "c1", start("e1"))
            await before.wait_until(lambda: len(before.reports) >= 2)
        again = RobotRegistry(journal, time.monotonic)
        after = RecordingSink(journal)
        again.assign("demo", after)
        async with served(again, TOKEN, port=urlsplit(url).port or 0):
            await after.wait_until(lambda: "finished" in after.types())
    assert after.hellos[0].boot == before.hellos[0].boot
    assert [each.seq for each in before.receipts + after.receipts] == list(range(1, 10))


async def test_a_later_start_delivers_what_the_earlier_one_left(
    journal: SqliteJournal, tmp_path: Path
) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    sink = RecordingSink(journal)
    registry.assign("demo", sink)
    outbox = ("--outbox", str(tmp_path / "outbox.db"))
    async with served(registry, TOKEN) as url:
        async with example_robot(url, "--step-s", "0.02", *outbox):
            await sink.wait_until(lambda: len(sink.hellos) == 1)
            registry.send("demo", "c1", start("e1"))
            await sink.wait_until(lambda: len(sink.reports) >= 1)
        async with example_robot(url, *outbox):
            await sink.wait_until(lambda: len(sink.hellos) == 2)
            registry.send("demo", "c2", start("e2"))
            await sink.wait_until(lambda: "finished" in sink.types())
    first, second = (hello.boot for hello in sink.hellos)
    for boot in (first, second):
        seqs = [each.seq for each in sink.receipts if each.boot == boot]
        assert seqs == list(range(1, len(seqs) + 1))


async def test_it_says_where_it_calls_and_why_nobody_answers_and_keeps_trying(
    journal: SqliteJournal,
) -> None:
    port = free_port()
    url = f"ws://127.0.0.1:{port}/ws/robot"
    async with example_robot(url) as process, asyncio.timeout(60):
        assert process.stderr is not None
        calls = (await process.stderr.readline()).decode()
        fails = (await process.stderr.readline()).decode()
        registry = RobotRegistry(journal, time.monotonic)
        async with served(registry, TOKEN, port):
            comes = (await process.stderr.readline()).decode()
        says = (await process.stderr.readline()).decode()
        loses = (await process.stderr.readline()).decode()
    assert says == "demo: the service says: the service is shutting down\n"
    assert calls == f"demo: calling {url}\n"
    assert fails.startswith(f"demo: nobody answers at {url}: ")
    assert "111" in fails
    assert fails.endswith("is 'mend serve' running? Trying again ...\n")
    assert comes == f"demo: connected to {url}\n"
    assert loses.startswith("demo: ")
    assert "Trying again" in loses


async def test_a_wrong_address_is_told_as_one() -> None:
    async with asyncio.timeout(60):
        server = await asyncio.start_server(not_found, "127.0.0.1", 0)
        port = server.sockets[0].getsockname()[1]
        async with example_robot(f"ws://127.0.0.1:{port}/ws/robots") as process:
            assert process.stderr is not None
            await process.stderr.readline()
            told = (await process.stderr.readline()).decode()
        server.close()
    assert f"ws://127.0.0.1:{port}/ws/robots answers with HTTP 404" in told


async def not_found(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    await reader.readuntil(b"\r\n\r\n")
    writer.write(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n")
    writer.close()


async def test_a_wrong_token_ends_it_with_a_sentence(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    async with served(registry, "another") as url, example_robot(url) as process:
        _, complaint = await process.communicate()
    assert process.returncode == 1
    assert b"has to present its credential" in complaint
    assert b"Traceback" not in complaint
