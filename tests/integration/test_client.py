import asyncio
import socket as sockets
from collections.abc import AsyncIterator
from typing import Any
from uuid import uuid4

import pytest
from fastapi import FastAPI
from pydantic import TypeAdapter
from recorded_service import recorded_events
from sample_events import detected, paused
from service_under_test import TOKEN, ServiceUnderTest, build, serving

from mend.server.client import MendClient
from mend.server.client_errors import (
    CommandRefusedError,
    RefusedError,
    StreamRefusedError,
    UnreachableError,
)
from mend.server.client_wire import IDLE_S
from mend.server.journal.events import Answered, Event, RunAborted, RunStarted
from mend.server.journal.journal import Entry
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, Snapshot
from mend.server.serving import serve_config
from mend.server.settings import Settings
from mend.tasks.intervention import Act, Intervention

REQUEST = RunRequest(tree="eket", world="tabletop", speed="max", seed=7)


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving(token=TOKEN) as service:
        yield service


@pytest.fixture
async def client(service: ServiceUnderTest) -> AsyncIterator[MendClient]:
    async with MendClient(service.url, token=TOKEN) as client:
        await client.wait_until_ready()
        yield client


async def test_trees_are_kept_and_deleted(client: MendClient) -> None:
    tree = await client.upload_tree("then: []", "mine")
    kept = await client.tree("mine")
    assert kept.model_dump() == tree.model_dump(exclude={"worlds"})
    assert [each.name for each in await client.trees()] == ["eket", "mine", "tea_table"]
    await client.delete_tree("mine")
    with pytest.raises(RefusedError, match="there is no task tree 'mine'") as refused:
        await client.tree("mine")
    assert refused.value.problem.status == 404
    assert "eket_paper" in [each.name for each in await client.scenarios()]


async def test_run_from_start_to_end(client: MendClient) -> None:
    run = await client.start_run(REQUEST)
    assert (await client.pause(run.id)).status is RunStatus.PAUSED
    assert (await client.resume(run.id)).status is RunStatus.RUNNING
    await client.intervene(run.id, Intervention(act=Act.STEAL, object="pink_bar"))
    assert (await client.camera(run.id, "head")).startswith(b"\xff\xd8")
    waiting = asyncio.create_task(client.wait_for_end(run.id))
    await client.abort(run.id)
    assert (await waiting).status is RunStatus.ABORTED
    events = await client.events(run.id, limit=2)
    assert isinstance(events[0], RunStarted)
    rest = await client.events(run.id, after=events[-1].seq)
    assert isinstance(rest[-1], RunAborted)
    assert [each.id for each in await client.runs()] == [run.id]
    assert (await client.robots())[0].robot == "robot"


async def test_dialogue_is_claimed_and_answered_once(
    client: MendClient, service: ServiceUnderTest
) -> None:
    run = await client.start_run(REQUEST)
    await service.runs.raise_issue(run.id)
    (view,) = await client.dialogues("open")
    assert view.prompt is not None
    assert (await client.claim(view.dialogue, "anna")).claimed_by == "anna"
    assert (await client.release(view.dialogue, "anna")).claimed_by is None
    answered = await client.answer(view.dialogue, view.prompt.prompt, "no", "anna")
    assert (answered.answer, answered.helper) == ("no", "anna")
    with pytest.raises(RefusedError) as refused:
        await client.answer(view.dialogue, view.prompt.prompt, "yes", "ben")
    assert refused.value.problem.answered_by == "anna"
    assert (await client.dialogue(view.dialogue)).status == "closed"


async def test_stream_gives_a_snapshot_and_answers_on_the_way(
    client: MendClient, service: ServiceUnderTest
) -> None:
    run = await client.start_run(REQUEST)
    view = await service.runs.raise_issue(run.id)
    assert view.prompt is not None
    async with client.follow("anna") as stream:
        messages = aiter(stream)
        snapshot = await anext(messages)
        assert isinstance(snapshot, Snapshot)
        assert stream.seen == snapshot.seq
        await stream.claim(view.dialogue)
        result = await stream.answer(view.dialogue, view.prompt.prompt, "yes")
        assert result["helper"] == "anna"
        with pytest.raises(CommandRefusedError) as refused:
            await stream.answer(view.dialogue, view.prompt.prompt, "no")
        assert refused.value.error.answered_by == "anna"
        events = [await anext(messages) for _ in range(3)]
        assert [event.seq for event in events] == [snapshot.seq + n for n in (1, 2, 3)]
        assert isinstance(events[1], Answered)
        assert stream.seen == events[-1].seq


async def test_a_word_on_promised_help_goes_by_request_and_on_the_stream(
    client: MendClient, service: ServiceUnderTest
) -> None:
    run = await client.start_run(REQUEST)
    view = await service.runs.raise_issue(run.id)
    await service.runs.await_help(view.dialogue, "anna")
    assert (await client.said_done(view.dialogue, "ben")).helper == "ben"
    with pytest.raises(RefusedError) as looks_already:
        await client.said_done(view.dialogue, "anna")
    assert looks_already.value.problem.status == 409
    async with client.follow("anna") as stream:
        messages = aiter(stream)
        await anext(messages)
        with pytest.raises(CommandRefusedError):
            await stream.said_done(view.dialogue)
        result = await stream.take_back(view.dialogue)
        assert (result["type"], result["helper"]) == ("promise_taken_back", "anna")
        with pytest.raises(CommandRefusedError) as none_awaited:
            await stream.take_back(view.dialogue)
        assert none_awaited.value.error.status == 409
    with pytest.raises(RefusedError):
        await client.take_back(view.dialogue, "anna")


async def collect(messages: AsyncIterator[Snapshot | Event], count: int) -> list[int]:
    async with asyncio.timeout(60):
        return [(await anext(messages)).seq for _ in range(count)]


async def test_stream_goes_on_after_lost_connections_without_gap(
    client: MendClient, service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.client_stream.FIRST_PAUSE_S", 0.01)
    run = uuid4()
    async with client.follow("anna") as stream:
        messages = aiter(stream)
        assert isinstance(await anext(messages), Snapshot)
        for _ in range(3):
            start = service.journal.head
            await service.runs.commit(*(paused(run=run) for _ in range(5)))
            assert await collect(messages, 5) == list(range(start + 1, start + 6))
            socket = stream._socket
            assert socket is not None
            socket.transport.abort()
            await service.runs.commit(*(paused(run=run) for _ in range(5)))
            assert await collect(messages, 5) == list(range(start + 6, start + 11))


async def test_an_event_with_a_detection_comes_as_it_was_committed(
    client: MendClient, service: ServiceUnderTest
) -> None:
    async with client.follow("anna") as stream:
        messages = aiter(stream)
        assert isinstance(await anext(messages), Snapshot)
        [raised] = await service.journal.append(Entry(events=[detected()]))
        async with asyncio.timeout(60):
            assert await anext(messages) == raised


async def test_stream_gives_every_event_of_a_real_run(
    client: MendClient, service: ServiceUnderTest
) -> None:
    recorded = recorded_events()
    async with client.follow("anna") as stream:
        messages = aiter(stream)
        await anext(messages)
        await service.runs.commit(*recorded)
        async with asyncio.timeout(60):
            came = [await anext(messages) for _ in recorded]
    assert [told(each) for each in came] == [told(each) for each in recorded]


def told(event: Snapshot | Event) -> dict[str, Any]:
    return event.model_dump(exclude={"seq"})


async def test_stream_ends_with_a_sentence_at_what_it_cannot_read(
    client: MendClient, service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.client_stream.any_event", TypeAdapter(RunAborted))
    async with client.follow("anna") as stream:
        messages = aiter(stream)
        await anext(messages)
        await service.runs.commit(paused())
        with pytest.raises(StreamRefusedError, match="is it of another version"):
            async with asyncio.timeout(60):
                await anext(messages)


async def test_wrong_token_ends_the_stream(service: ServiceUnderTest) -> None:
    async with MendClient(service.url, token="wrong") as client:
        async with client.follow("anna") as stream:
            with pytest.raises(StreamRefusedError):
                await anext(aiter(stream))
        with pytest.raises(StreamRefusedError, match="check the token"):
            async with client.talk("anna"):
                pass
        with pytest.raises(RefusedError):
            await client.runs()


async def test_no_service_is_one_clear_sentence() -> None:
    with sockets.socket() as free:
        free.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{free.getsockname()[1]}"
    async with MendClient(url) as client:
        with pytest.raises(UnreachableError, match="no service answers at"):
            await client.runs()
        with pytest.raises(UnreachableError, match="no service answers at"):
            async with client.talk("anna"):
                pass
        with pytest.raises(UnreachableError, match="no service is ready at"):
            await client.wait_until_ready(timeout_s=0.05)


async def test_answer_of_something_else_is_a_problem() -> None:
    service = build()
    async with MendClient("http://localhost") as client, service.client() as stand_in:
        client._http = stand_in
        with pytest.raises(RefusedError) as refused:
            await client._request("GET", "/nowhere")
        assert refused.value.problem.status == 404
    service.journal.close()


def test_the_client_lets_idle_connections_go_before_the_service_does() -> None:
    assert serve_config(FastAPI(), Settings()).timeout_keep_alive > IDLE_S
