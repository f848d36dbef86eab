import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID, uuid4

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sample_events import paused
from service_under_test import ServiceUnderTest, serving
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from mend.server.journal.pruning import Keep
from mend.server.limits import Limits
from mend.server.runtime.requests import RunRequest

REQUEST = RunRequest(tree="eket", world="tabletop", speed="max")


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving() as service:
        yield service


def helper(service: ServiceUnderTest, query: str = "helper=anna", **more: Any) -> connect:
    return connect(f"{service.ws}?{query}", **more)


async def receive(socket: ClientConnection) -> Any:
    async with asyncio.timeout(60):
        return json.loads(await socket.recv())


async def exchange(socket: ClientConnection, message: str | bytes) -> Any:
    await socket.send(message)
    return await receive(socket)


async def test_snapshot_comes_first_then_every_event_after_it(service: ServiceUnderTest) -> None:
    run = await service.runs.start_run(REQUEST)
    async with helper(service) as socket:
        snapshot = await receive(socket)
        assert snapshot["type"] == "snapshot"
        assert snapshot["seq"] == 1
        assert [each["id"] for each in snapshot["runs"]] == [str(run.id)]
        view = await service.runs.raise_issue(run.id)
        raised, opened, prompt = [await receive(socket) for _ in range(3)]
        assert [raised["seq"], opened["seq"], prompt["seq"]] == [2, 3, 4]
        assert raised["type"] == "issue_raised"
        assert opened["type"] == "dialogue_opened"
        assert prompt["type"] == "prompt"
        assert prompt["dialogue"] == str(view.dialogue)
        assert [each["value"] for each in prompt["answers"]] == ["yes", "no"]


async def test_helpers_are_told_when_the_journal_cannot_be_written(
    service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    # It would be found out that it can be written, however long a helper takes to connect.
    monkeypatch.setattr(service.journal.trouble, "_sleep", lambda _: asyncio.Event().wait())
    async with helper(service) as before:
        assert (await receive(before))["type"] == "snapshot"
        service.journal.trouble.began("the disk is full")
        assert await receive(before) == {"type": "trouble", "reason": "the disk is full"}
        async with helper(service) as later:
            assert (await receive(later))["type"] == "snapshot"
            assert await receive(later) == {"type": "trouble", "reason": "the disk is full"}
            service.journal.trouble.ended(probed=True)
            for socket in (before, later):
                assert await receive(socket) == {"type": "trouble", "reason": None}


async def test_who_floods_is_read_at_their_pace_and_nobody_else_waits() -> None:
    limits = Limits(helper_messages_per_s=1)
    async with serving(limits=limits) as service, helper(service) as flooding:
        assert (await receive(flooding))["type"] == "snapshot"
        for number in range(100):
            await flooding.send(json.dumps({"type": "ping", "id": number}))
        await service.refused("helper_messages_per_s")
        async with helper(service, "helper=ben") as other:
            assert (await receive(other))["type"] == "snapshot"
            assert (await exchange(other, '{"type": "ping", "id": 1}'))["id"] == 1
        assert service.refusals.counts["helper_messages_per_s"] < 100


async def test_after_replays_what_was_missed(service: ServiceUnderTest) -> None:
    run = await service.runs.start_run(REQUEST)
    for _ in range(3):
        await service.runs.raise_issue(run.id)
    async with helper(service, "helper=anna&after=3") as socket:
        assert (await receive(socket))["seq"] == 3
        assert [(await receive(socket))["seq"] for _ in range(4)] == [4, 5, 6, 7]


async def test_after_that_lies_ahead_gets_the_head_and_an_error(service: ServiceUnderTest) -> None:
    await service.runs.start_run(REQUEST)
    async with helper(service, "helper=anna&after=99") as socket:
        assert (await receive(socket))["seq"] == 1
        error = await receive(socket)
        assert error["type"] == "error"
        assert "99" in error["detail"]


async def test_after_from_before_what_was_pruned_gets_the_state_of_now_and_says_so(
    service: ServiceUnderTest,
) -> None:
    ended = await service.runs.start_run(REQUEST)
    await service.runs.abort(ended.id)
    going_on = await service.runs.start_run(REQUEST)
    await service.runs.commit(paused(run=going_on.id))
    await service.journal.prune(Keep(ended_within=timedelta(0)), datetime.now(UTC) + timedelta(1))
    async with helper(service, "helper=anna&after=1") as socket:
        snapshot = await receive(socket)
        assert (snapshot["seq"], len(snapshot["runs"])) == (4, 1)
        error = await receive(socket)
        assert (error["type"], error["status"]) == ("error", 410)
        assert "not every event after 1 is there any more: some up to 2 were" in error["detail"]
        await service.runs.commit(paused(run=going_on.id))
        assert (await receive(socket))["seq"] == 5
    async with helper(service, "helper=anna&after=2") as socket:
        assert [(await receive(socket))["seq"] for _ in range(4)] == [2, 3, 4, 5]


async def test_answer_is_confirmed_and_the_second_one_is_told_who_was_first(
    service: ServiceUnderTest,
) -> None:
    run = await service.runs.start_run(REQUEST)
    view = await service.runs.raise_issue(run.id)
    assert view.prompt is not None
    answer = {
        "type": "answer",
        "dialogue": str(view.dialogue),
        "prompt": str(view.prompt.prompt),
        "answer": "yes",
        "id": 7,
    }
    async with helper(service) as anna, helper(service, "helper=ben") as ben:
        await receive(anna)
        await receive(ben)
        await anna.send(json.dumps(answer))
        seen = [await receive(anna) for _ in range(3)]
        result = next(each for each in seen if each["type"] == "result")
        assert result["id"] == 7
        assert result["result"]["helper"] == "anna"
        assert {each["type"] for each in seen} == {"result", "answered", "dialogue_closed"}
        await ben.send(json.dumps({**answer, "id": "mine"}))
        heard = [await receive(ben) for _ in range(3)]
        error = next(each for each in heard if each["type"] == "error")
        assert error["id"] == "mine"
        assert error["status"] == 409
        assert error["answered_by"] == "anna"


async def test_claim_and_release_are_seen_by_others(service: ServiceUnderTest) -> None:
    run = await service.runs.start_run(REQUEST)
    view = await service.runs.raise_issue(run.id)
    async with helper(service) as anna, helper(service, "helper=ben") as ben:
        await receive(anna)
        await receive(ben)
        await anna.send(json.dumps({"type": "claim", "dialogue": str(view.dialogue)}))
        claimed = await receive(ben)
        assert (claimed["type"], claimed["helper"]) == ("claimed", "anna")
        refused = await exchange(ben, json.dumps({"type": "claim", "dialogue": str(view.dialogue)}))
        assert refused["status"] == 409
        await anna.send(json.dumps({"type": "release", "dialogue": str(view.dialogue)}))
        assert (await receive(ben))["type"] == "released"


@pytest.mark.parametrize(
    "message",
    [
        "",
        "{",
        "null",
        "[]",
        "7",
        '"answer"',
        "{}",
        '{"type": "dance"}',
        '{"type": ["answer"]}',
        '{"type": "answer"}',
        '{"type": "answer", "dialogue": "x", "prompt": "y", "answer": "yes"}',
        '{"type": "claim", "dialogue": 7}',
        '{"type": "ping", "more": 1}',
        '{"type": "ping", "id": {}}',
        '{"type": "ping", "id": 1' + "0" * 6000 + "}",
        '{"type": "ping", "id": "\\ud800"}',
        '{"type": "ping", "id": NaN}',
        "[" * 60_000,
        "x" * 70_000,
        b"\x00\x01",
        b'{"type": "ping"}',
    ],
    ids=lambda message: repr(message[:30]),
)
async def test_malformed_message_gets_an_error_and_the_connection_stays(
    service: ServiceUnderTest, message: str | bytes
) -> None:
    async with helper(service) as socket:
        await receive(socket)
        error = await exchange(socket, message)
        assert error["type"] == "error"
        assert error["detail"]
        pong = await exchange(socket, '{"type": "ping", "id": 1}')
        assert (pong["type"], pong["id"]) == ("result", 1)
    assert service.journal.head == 0


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=8,
)
MESSAGES = st.fixed_dictionaries(
    {"type": st.sampled_from(["answer", "claim", "release", "ping", "auth"])},
    optional={
        "id": JSON,
        "dialogue": st.uuids().map(str) | JSON,
        "prompt": st.uuids().map(str) | JSON,
        "answer": st.sampled_from(["yes", "no"]) | JSON,
        "token": JSON,
    },
)


async def test_random_messages_get_one_reply_each_and_change_nothing(
    service: ServiceUnderTest,
) -> None:
    run = await service.runs.start_run(REQUEST)
    await service.runs.raise_issue(run.id)
    head = service.journal.head
    batches: list[list[Any]] = []

    @settings(deadline=None, max_examples=60, suppress_health_check=list(HealthCheck))
    @given(st.lists(MESSAGES | JSON, min_size=1, max_size=5))
    def draw(messages: list[Any]) -> None:
        batches.append(messages)

    draw()
    async with helper(service) as socket:
        await receive(socket)
        for message in [message for batch in batches for message in batch]:
            reply = await exchange(socket, json.dumps(message))
            assert reply["type"] in ("result", "error")
    assert service.journal.head == head


@pytest.mark.parametrize(
    "query", ["", "helper=", "helper=a%00b", "helper=a&after=x", "helper=a&after=-1"]
)
async def test_wrong_address_is_explained_before_the_close(
    service: ServiceUnderTest, query: str
) -> None:
    async with helper(service, query) as socket:
        error = await receive(socket)
        assert error["type"] == "error"
        assert error["errors"]
        with pytest.raises(ConnectionClosed) as closed:
            await socket.recv()
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1008


async def follow(service: ServiceUnderTest, after: int, until: int) -> list[int]:
    async with helper(service, f"helper=anna&after={after}") as socket:
        snapshot = await receive(socket)
        assert snapshot["seq"] == after
        return [(await receive(socket))["seq"] for _ in range(until - after)]


async def test_no_gap_and_no_duplicate_under_concurrent_appends(
    service: ServiceUnderTest,
) -> None:
    total, step = 600, 3
    followers = []

    async def produce(run: UUID) -> None:
        for number in range(total // 4 // step):
            await service.runs.commit(*(paused(float(number), run) for _ in range(step)))
            if number % 10 == 0:
                after = service.journal.head // 2
                followers.append((after, asyncio.create_task(follow(service, after, total))))

    await asyncio.gather(*(produce(uuid4()) for _ in range(4)))
    assert service.journal.head == total
    assert len(followers) >= 16
    for after, task in followers:
        assert await task == list(range(after + 1, total + 1))


async def test_stuck_client_is_closed_with_1013_while_others_get_everything() -> None:
    async with serving(subscriber_queue=50) as service:
        run = uuid4()
        async with (
            helper(service, "helper=stuck", max_queue=1) as stuck,
            helper(service, "helper=good", max_queue=None) as good,
        ):
            await receive(stuck)
            await receive(good)
            seen = 0
            while service.journal.subscribers.overflows == 0:
                await service.runs.commit(*(big(run) for _ in range(20)))
                for _ in range(20):
                    seen += 1
                    assert (await receive(good))["seq"] == seen
            assert len(service.journal.subscribers) == 1
            last = 0
            with contextlib.suppress(ConnectionClosed):
                async for text in stuck:
                    last = json.loads(text)["seq"]
            assert stuck.close_code == 1013
        assert 0 < last < seen
        assert await follow(service, last, seen) == list(range(last + 1, seen + 1))


def big(run: UUID) -> Any:
    """An event that fills the buffers of a socket soon."""
    from mend.server.journal.events import RunFailed

    return RunFailed(
        **paused(run=run).model_dump(exclude={"type", "seq", "author"}), reason="x" * 20_000
    )
