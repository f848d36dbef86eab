"""Runs of the world `live`, on example robots that connect over the protocol."""

import asyncio
import contextlib
import json
from collections import Counter
from collections.abc import AsyncIterator
from pathlib import Path
from urllib.parse import urlsplit
from uuid import UUID

import pytest
import yaml
from example_robot import TOKEN, example_robot
from live_service import LiveService, live_service
from pretend_service import OneTree
from recording_sink import RecordingSink
from task_documents import definition_of

import mend.tasks
from mend.robots.link.channel import memory_channel
from mend.robots.link.messages import Hello, Holding, ReachLimits, Report
from mend.server.journal.sqlite import SqliteJournal
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunSummary
from mend.tasks.scene import Scene

pytestmark = pytest.mark.slow

PARTS = ("green_leg", "pink_bar", "yellow_bar", "blue_leg")


def part(name: str, place: str | None = None) -> dict[str, str]:
    return {"behavior": "pick_and_place", "object": name, "place": place or f"{name}_place"}


def eket() -> OneTree:
    green, pink, yellow, blue = (part(name) for name in PARTS)
    tops = [part(name, "top_place") for name in ("purple_top", "orange_top")]
    tree = {"then": [green, {"and": [pink, yellow]}, blue, {"or": tops}]}
    scene = yaml.safe_load((Path(mend.tasks.__file__).parent / "scenes" / "eket.yaml").read_text())
    return OneTree(definition_of(tree), Scene.model_validate_json(json.dumps(scene)))


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


async def start_when_connected(service: LiveService, *robots: str) -> RunSummary:
    waiting = RecordingSink(service.journal)
    for robot in robots:
        service.registry.assign(robot, waiting)
    await waiting.wait_until(lambda: waiting.robots == set(robots))
    for robot in robots:
        service.registry.unassign(robot)
    return await service.runtime.start_run(
        RunRequest(tree="eket", world="live", robots=list(robots))
    )


async def done_by_name(journal: SqliteJournal, run: UUID) -> Counter[str]:
    events = await journal.read(0, 10_000, run)
    return Counter(each.name for each in events if each.type == "node_done")


async def third_step(journal: SqliteJournal) -> None:
    """Wait until some behavior's third step has begun."""
    async with asyncio.timeout(60):
        with journal.subscribe(0) as records:
            async for record in records:
                if '"step":3' in record.text:
                    return


async def test_the_example_robot_builds_eket(journal: SqliteJournal) -> None:
    async with (
        live_service(journal, eket(), token=TOKEN) as service,
        example_robot(service.url),
    ):
        run = await start_when_connected(service, "demo")
        ended = await asyncio.wait_for(service.runtime.wait_for_end(run.id), 60)
    assert ended.status is RunStatus.FINISHED
    assert ended.result is not None
    assert ended.result.missing == []
    done = await done_by_name(journal, run.id)
    assert all(done[name] == 1 for name in PARTS)
    assert done["purple_top"] + done["orange_top"] == 1


async def test_two_robots_share_the_work(journal: SqliteJournal) -> None:
    async with (
        live_service(journal, eket(), token=TOKEN) as service,
        example_robot(service.url, name="left"),
        example_robot(service.url, name="right"),
    ):
        run = await start_when_connected(service, "left", "right")
        ended = await asyncio.wait_for(service.runtime.wait_for_end(run.id), 60)
    assert ended.status is RunStatus.FINISHED
    assert sum((await done_by_name(journal, run.id)).values()) == 5


async def test_a_robot_that_is_killed_in_the_middle_comes_back_and_finishes(
    journal: SqliteJournal, tmp_path: Path
) -> None:
    outbox = ("--outbox", str(tmp_path / "outbox.db"))
    async with live_service(journal, eket(), token=TOKEN) as service:
        async with example_robot(service.url, "--step-s", "0.03", *outbox) as robot:
            run = await start_when_connected(service, "demo")
            await third_step(journal)
            robot.kill()
        async with example_robot(service.url, *outbox):
            ended = await asyncio.wait_for(service.runtime.wait_for_end(run.id), 60)
    assert ended.status is RunStatus.FINISHED
    assert sum((await done_by_name(journal, run.id)).values()) == 5


async def test_a_run_goes_on_when_the_service_was_started_again(journal: SqliteJournal) -> None:
    async with contextlib.AsyncExitStack() as robot:
        async with live_service(journal, eket(), token=TOKEN) as service:
            await robot.enter_async_context(example_robot(service.url, "--step-s", "0.03"))
            run = await start_when_connected(service, "demo")
            await third_step(journal)
        port = urlsplit(service.url).port or 0
        async with live_service(journal, eket(), token=TOKEN, port=port) as again:
            ended = await asyncio.wait_for(again.runtime.wait_for_end(run.id), 60)
    assert ended.status is RunStatus.FINISHED
    assert sum((await done_by_name(journal, run.id)).values()) == 5


async def test_what_an_earlier_boot_left_is_recorded_and_is_no_news(
    journal: SqliteJournal,
) -> None:
    async with live_service(journal, eket(), token=TOKEN) as service:
        robot, service_end = memory_channel()
        serving = asyncio.create_task(service.registry.serve(service_end))
        hello = Hello(
            protocol=1, robot="demo", boot="b2", behaviors=["pick_and_place"], cameras=[],
            reach=ReachLimits(x=0.0, y=0.0, min_m=0.2, max_m=1.2), time=0.0,
        )  # fmt: skip
        await robot.send(hello.model_dump_json())
        run = await start_when_connected(service, "demo")
        stale = Report(
            boot="b1", seq=3, time=9.0, body=Holding(execution="an old one", at="in_place")
        )
        await robot.send(stale.model_dump_json())
        async with asyncio.timeout(60):
            while '"ack"' not in await robot.receive():
                pass
        events = await journal.read(0, 100, run.id)
        await robot.close()
        await serving
    assert [each.type for each in events] == ["run_started"]
    assert await journal.received("demo", "b1") == 3
