"""Robots and the service over real sockets."""

import asyncio
import random
import time
from collections.abc import AsyncIterator
from functools import partial

import pytest
from counting_agent import CountingAgent
from loopback import served
from recording_sink import RecordingSink

from mend.robots.link.channel import LinkRefusedError
from mend.robots.link.client import run_agent
from mend.robots.link.clock import LoopClock
from mend.robots.link.messages import Shutdown, Start
from mend.robots.link.outbox import IN_MEMORY, Outbox
from mend.robots.link.websocket import websocket_channel
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.registry import RobotRegistry


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


def start(execution: str) -> Start:
    return Start(execution=execution, node="/0", behavior="count", parameters={})


async def test_a_behavior_is_started_and_reported_over_a_websocket(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    sink = RecordingSink(journal)
    registry.assign("counter", sink)
    async with served(registry, "secret") as url:
        robot = asyncio.create_task(
            run_agent(
                CountingAgent(),
                partial(websocket_channel, url, "secret"),
                Outbox(IN_MEMORY, "counter", "boot-1"),
                LoopClock(),
                random.Random(0),
            )
        )
        await sink.wait_until(lambda: len(sink.hellos) == 1)
        registry.send("counter", "c1", start("e1"))
        await sink.wait_until(lambda: "finished" in sink.types())
        registry.send("counter", "c2", Shutdown())
        await robot
    assert sink.types() == ["step_started"] * 3 + ["finished"]
    assert await journal.received("counter", "boot-1") == 4


async def test_a_wrong_token_ends_the_robot_with_a_sentence(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    async with served(registry, "secret") as url:
        with pytest.raises(LinkRefusedError, match="has to present its credential"):
            await run_agent(
                CountingAgent(),
                partial(websocket_channel, url, "wrong"),
                Outbox(IN_MEMORY, "counter", "boot-1"),
                LoopClock(),
                random.Random(0),
            )
