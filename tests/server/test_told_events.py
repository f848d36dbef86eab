"""Whoever shows a run gets each event with the transcript's own lines, and words nothing itself."""

import json
from collections.abc import AsyncIterator
from typing import Any

import httpx
import pytest
from recorded_service import recorded_events
from service_under_test import ServiceUnderTest, serving
from websockets.asyncio.client import connect

from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.runtime.requests import RunRequest
from mend.server.transcript import Transcript
from mend.server.transcript_line import Line, Tone


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving() as service:
        yield service


def line_of(told: dict[str, Any]) -> Line:
    return Line(**{**told, "tone": Tone(told["tone"])})


async def kept(service: ServiceUnderTest, robots: list[str]) -> tuple[str, list[list[Line]]]:
    """Commit the recorded run, with these robots; its id, and what the transcript tells of it."""
    events = recorded_events()
    assert isinstance(events[0], ev.RunStarted)
    events[0] = events[0].model_copy(update={"robots": robots})
    await service.journal.append(Entry(events))
    transcript = Transcript()
    return str(events[0].run), [transcript.lines(each) for each in events]


@pytest.mark.parametrize("robots", [["pr2"], ["left", "right"]])
async def test_every_event_of_a_run_comes_with_its_lines(
    service: ServiceUnderTest, robots: list[str]
) -> None:
    run, expected = await kept(service, robots)
    path = f"{service.url}/api/runs/{run}/events?limit=1000"
    async with httpx.AsyncClient() as client:
        plain = (await client.get(path)).json()
        told = (await client.get(f"{path}&told=true")).json()
        later = (await client.get(f"{path}&told=true&after={told[4]['seq']}")).json()
    lines = [[line_of(each) for each in event.pop("lines")] for event in told]
    assert lines == expected
    assert told == plain
    assert [[line_of(each) for each in event["lines"]] for event in later] == expected[5:]


async def test_a_live_event_has_its_lines_with_it(service: ServiceUnderTest) -> None:
    run = await service.runs.start_run(RunRequest(tree="eket", world="tabletop"))
    async with connect(f"{service.ws}?helper=anna&told=true") as socket:
        assert json.loads(await socket.recv())["type"] == "snapshot"
        view = await service.runs.raise_issue(run.id)
        raised, opened, prompt = [json.loads(await socket.recv()) for _ in range(3)]
        assert raised["lines"][0]["text"].startswith("issue: dropped")
        assert opened["lines"] == []
        assert view.prompt is not None
        assert [each["text"] for each in prompt["lines"]] == [view.prompt.text]
        another = await service.runs.start_run(RunRequest(tree="eket", world="tabletop"))
        begins = json.loads(await socket.recv())
        assert begins["lines"][0]["text"].startswith(f"run {another.id} of eket begins in tabletop")
