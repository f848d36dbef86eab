"""Clients that stop reading are ended by the service itself, whatever they were sent."""

import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from urllib.parse import urlsplit
from uuid import uuid4

from raw_client import RawClient, raw_client, text_frame
from sample_events import started
from service_under_test import ServiceUnderTest, serving, until
from shown_run import hello
from ticking_clock import TickingClock
from websockets.frames import Frame, Opcode

from mend.server.api.robot_socket import add_robot_route
from mend.server.journal.events import RunFailed
from mend.server.journal.journal import Entry
from mend.server.limits import Limits
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.times import LinkTimes

# Robots may talk as fast as they like here: it is what they do not read that is looked at.
SOON = Limits(stuck_client_s=0.5, robot_messages_per_s=1_000_000)
EVENT_CHARS = 100_000
MORE_THAN_IS_BUFFERED = 200


def failed(number: int) -> RunFailed:
    now = datetime.now(UTC)
    return RunFailed(time=0.0, wall_time=now, run=uuid4(), reason=f"{number}" * EVENT_CHARS)


@asynccontextmanager
async def client_of(service: ServiceUnderTest) -> AsyncIterator[RawClient]:
    async with raw_client(urlsplit(service.url).port or 0) as client:
        yield client


async def ended(service: ServiceUnderTest) -> None:
    """Wait until the connection was ended for that, and nothing of it is left."""
    await service.refused("stuck_client_s")
    await service.left_alone()


async def test_a_helper_who_reads_nothing_is_ended() -> None:
    async with serving(limits=SOON, subscriber_queue=50) as service, client_of(service) as client:
        await client.upgraded("/ws/helper?helper=anna")
        for _ in range(MORE_THAN_IS_BUFFERED):
            await service.journal.append(Entry(events=[failed(1)]))
        await ended(service)
        # Its connection is gone before what served it has noticed.
        await until(lambda: len(service.journal.subscribers) == 0)


async def test_a_helper_who_reads_slowly_gets_everything() -> None:
    clock = TickingClock()
    limits = Limits(stuck_client_s=10.0)
    async with serving(limits=limits, now=clock) as service, client_of(service) as client:
        await client.upgraded("/ws/helper?helper=anna")
        events = [failed(number % 10) for number in range(MORE_THAN_IS_BUFFERED)]
        await service.journal.append(Entry(events=events))
        unread_chars = EVENT_CHARS * MORE_THAN_IS_BUFFERED
        while unread_chars > 0:
            # A tenth of what is allowed for taking anything, and 200 times as long for it all.
            clock.now_s += 1.0
            service.server.visitors.end_overdue()
            unread_chars -= len(await client.reader.readexactly(EVENT_CHARS))
        assert service.refusals.counts["stuck_client_s"] == 0


async def test_a_client_that_does_not_read_a_big_answer_is_ended() -> None:
    async with serving(limits=SOON) as service, client_of(service) as client:
        run = uuid4()
        await service.journal.append(Entry(events=[started(run)]))
        events = [failed(1).model_copy(update={"run": run}) for _ in range(MORE_THAN_IS_BUFFERED)]
        await service.journal.append(Entry(events=events))
        path = f"/api/runs/{run}/events?limit=1000"
        client.send(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        await ended(service)
        answer = await client.end()
        assert answer.startswith(b"HTTP/1.1 200 OK")
        assert len(answer) < EVENT_CHARS * MORE_THAN_IS_BUFFERED


async def test_a_client_that_pings_and_reads_nothing_fills_no_memory() -> None:
    async with serving(limits=SOON) as service, client_of(service) as client:
        await client.upgraded("/ws/helper?helper=anna")
        pings = Frame(Opcode.PING, bytes(125)).serialize(mask=True) * 10_000
        most = 0
        (connection,) = service.server.server_state.connections
        while not connection.transport.is_closing():
            client.send(pings)
            await client.drained()
            most = max(most, connection.transport.get_write_buffer_size())
        assert most < 1 << 20
        await service.left_alone()


async def test_a_robot_that_reads_nothing_is_ended() -> None:
    async with serving(limits=SOON) as service, client_of(service) as client:
        times = LinkTimes(silence_s=60.0)
        registry = RobotRegistry(service.journal, time.monotonic, times, SOON)
        add_robot_route(service.app, registry, service.app.state.services.access)
        await client.upgraded("/ws/robot")
        client.send(text_frame(hello(shows=None).model_dump_json()))
        # Each is answered with what is wrong with it.
        client.send(text_frame("{}") * 20_000)
        await ended(service)
        await until(lambda: not registry.connected("arm"))
        registry.close()
