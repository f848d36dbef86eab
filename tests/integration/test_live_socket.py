"""Watching a run over a real socket: layout, frames, admission, the end, and slow watchers."""

import asyncio
import json
import struct
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pytest
from service_under_test import TOKEN, ServiceUnderTest, serving
from shown_run import hello, poses, run_state
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from mend.server.composition import open_service
from mend.server.poses.feed import RunPoses
from mend.server.poses.frame import time_of, unframed
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings

NOBODY = "2dc8e3f6-6479-4c12-9baf-d2534d0b7e34"
REQUEST = RunRequest(tree="eket", world="tabletop", speed="max")


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving() as service:
        yield service


async def start(service: ServiceUnderTest) -> tuple[UUID, RunPoses]:
    """A run whose robot is there."""
    run = (await service.runs.start_run(REQUEST)).id
    shown = service.poses.open(run_state(run))
    shown.robot_connected(hello())
    return run, shown


def watch(service: ServiceUnderTest, query: str, **more: Any) -> connect:
    return connect(f"{service.url.replace('http', 'ws', 1)}/ws/live?{query}", **more)


async def receive(socket: ClientConnection) -> str | bytes:
    async with asyncio.timeout(60):
        return await socket.recv()


async def layout_from(socket: ClientConnection) -> Any:
    message = await receive(socket)
    assert isinstance(message, str)
    return json.loads(message)


async def time_from(socket: ClientConnection) -> float:
    message = await receive(socket)
    assert isinstance(message, bytes)
    return time_of(message)


async def code_at_end(socket: ClientConnection) -> int:
    with pytest.raises(ConnectionClosed) as ended:
        await receive(socket)
    assert ended.value.rcvd is not None
    return ended.value.rcvd.code


async def test_the_layout_comes_first_then_frames_as_they_are_shown(
    service: ServiceUnderTest,
) -> None:
    run, shown = await start(service)
    async with watch(service, f"run={run}&helper=anna") as socket:
        layout = await layout_from(socket)
        assert layout["type"] == "layout"
        assert layout["run"] == str(run)
        assert [each["name"] for each in layout["objects"]] == ["cup"]
        for step in range(5):
            shown.take("arm", float(step), poses())
            assert await time_from(socket) == float(step)


async def test_whoever_watches_a_run_has_none_of_its_nodes_viewed(
    service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = await start(service)
    monkeypatch.delattr(type(service.runs), "run")
    async with watch(service, f"run={run}&helper=anna") as socket:
        await layout_from(socket)
        await service.runs.abort(run)
        service.poses.close(run)
        assert await code_at_end(socket) == 1000
    async with httpx.AsyncClient(base_url=service.url) as client:
        assert (await client.get(f"/api/runs/{run}/layout")).status_code == 404
        assert (await client.get(f"/api/runs/{run}/poses")).status_code == 200
        assert (await client.get(f"/api/runs/{NOBODY}/poses")).status_code == 404


async def test_the_end_of_the_run_ends_the_connection(service: ServiceUnderTest) -> None:
    run, shown = await start(service)
    async with watch(service, f"run={run}&helper=anna") as socket:
        await layout_from(socket)
        shown.take("arm", 1.0, poses())
        await service.runs.abort(run)
        service.poses.close(run)
        assert await time_from(socket) == 1.0
        assert await code_at_end(socket) == 1000


async def test_a_service_that_stops_says_that_it_is_going_away(service: ServiceUnderTest) -> None:
    run, _ = await start(service)
    async with watch(service, f"run={run}&helper=anna") as socket:
        await layout_from(socket)
        service.poses.close(run)
        assert await code_at_end(socket) == 1001


async def test_nobody_is_asked_for_poses_once_the_last_watcher_has_left(
    service: ServiceUnderTest,
) -> None:
    run, shown = await start(service)
    asked: list[float] = []
    shown._show = lambda _robot, rate_hz: asked.append(rate_hz)
    async with watch(service, f"run={run}&helper=anna") as socket:
        await layout_from(socket)
        assert asked == [20.0]
    async with asyncio.timeout(60):
        while asked != [20.0, 0.0]:  # noqa: ASYNC110
            await asyncio.sleep(0)


@pytest.mark.parametrize(
    ("query", "status"),
    [
        (f"run={NOBODY}&helper=anna", 404),
        ("run=7&helper=anna", 422),
        (f"run={NOBODY}", 422),
        (f"run={NOBODY}&helper=", 422),
        ("", 422),
    ],
)
async def test_a_wrong_address_is_told_and_closed(
    service: ServiceUnderTest, query: str, status: int
) -> None:
    async with watch(service, query) as socket:
        error = await layout_from(socket)
        assert (error["type"], error["status"]) == ("error", status)
        assert await code_at_end(socket) == 1008


async def test_what_a_watcher_says_changes_nothing(service: ServiceUnderTest) -> None:
    run, shown = await start(service)
    async with watch(service, f"run={run}&helper=anna") as socket:
        await layout_from(socket)
        await socket.send("anything")
        await socket.send(b"\x00")
        shown.take("arm", 1.0, poses())
        assert await time_from(socket) == 1.0


async def test_the_token_comes_in_a_header_or_the_first_message_and_never_from_elsewhere() -> None:
    async with serving(token=TOKEN) as service:
        run, _ = await start(service)
        query = f"run={run}&helper=anna"
        right = {"Authorization": f"Bearer {TOKEN}"}
        async with watch(service, query, additional_headers=right) as socket:
            assert (await layout_from(socket))["type"] == "layout"
        async with watch(service, query) as socket:
            await socket.send(json.dumps({"type": "auth", "token": TOKEN}))
            assert (await layout_from(socket))["type"] == "layout"
        for said in ('{"type": "auth", "token": "wrong"}', "{", '{"type": "ping"}'):
            async with watch(service, query) as socket:
                await socket.send(said)
                assert await code_at_end(socket) == 1008
        async with watch(service, f"{query}&token={TOKEN}") as socket:
            await socket.send("{}")
            assert await code_at_end(socket) == 1008
        with pytest.raises(Exception, match="403"):
            async with watch(service, query, origin="https://evil.example"):
                pass


@pytest.mark.slow
async def test_a_watcher_that_does_not_read_holds_up_nobody_and_costs_no_memory(
    service: ServiceUnderTest,
) -> None:
    run, shown = await start(service)
    query = f"run={run}&helper"
    async with (
        watch(service, f"{query}=stuck", max_queue=1) as stuck,
        watch(service, f"{query}=anna") as socket,
    ):
        await layout_from(socket)
        big = poses(joints=1)
        for step in range(20_000):
            shown.take("arm", float(step), big)
            if step % 1000 == 0:
                assert await time_from(socket) <= float(step)
        while await time_from(socket) < 19_999.0:
            pass
        assert len(shown._watchers) == 2
        stuck.transport.abort()


@pytest.mark.slow
async def test_a_whole_run_is_watched_and_replayed(tmp_path: Path) -> None:
    settings = Settings(port=0, data_dir=tmp_path, log_level="critical", speech_voice="none")
    async with open_service(settings) as service:
        request = RunRequest(
            tree="eket", world="tabletop", speed=10.0, seed=1, answers=["yes"] * 50
        )
        run = await service.runtime.start_run(request)
        address = f"{service.url.replace('http', 'ws', 1)}/ws/live?run={run.id}&helper=anna"
        seen: list[bytes] = []
        async with connect(address) as socket:
            layout = await layout_from(socket)
            async with asyncio.timeout(60):
                async for message in socket:
                    assert isinstance(message, bytes)
                    seen.append(message)
            assert socket.close_code == 1000
        assert layout["model"] is None
        assert [each["kind"] for each in layout["objects"]][-1] == "obstacle"
        times = [time_of(each) for each in seen]
        assert times == sorted(times)
        assert len(times) > 50
        async with httpx.AsyncClient(base_url=service.url) as client:
            replay = await client.get(f"/api/runs/{run.id}/poses")
            kept = list(unframed(replay.content))
            assert len(kept) > 50
            objects = len(layout["objects"])
            assert {len(each) for each in kept} == {76 + 32 * objects}
            first, last = replay.headers["mend-poses-span"].split()
            assert float(last) > float(first) >= 0.0
            from_s, to_s = (time_of(kept[len(kept) * part // 4]) for part in (1, 3))
            span = await client.get(f"/api/runs/{run.id}/poses?from_s={from_s}&to_s={to_s}")
            inside = [each for each in kept if from_s <= time_of(each) <= to_s]
            assert list(unframed(span.content)) == inside
            assert (await client.get(f"/api/runs/{run.id}/layout")).json() == layout
        held = [
            struct.unpack_from("<I", each, 76 + 32 * i + 28)[0] & 1
            for each in kept
            for i in range(objects)
        ]
        assert any(held)
        async with connect(address) as socket:
            assert await layout_from(socket) == layout
            assert await time_from(socket) == time_of(kept[-1])
            assert await code_at_end(socket) == 1000
    async with (
        open_service(settings) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        after = await client.get(f"/api/runs/{run.id}/poses")
        assert after.content == replay.content
