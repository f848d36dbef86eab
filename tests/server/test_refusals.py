"""What is beyond a limit is counted by that limit, and Prometheus may know it."""

import asyncio
import json
import re
from pathlib import Path
from typing import Any, get_args
from uuid import uuid4

import pytest
from service_under_test import TOKEN, build, serving
from websockets.asyncio.client import connect

from mend.errors import ConflictError
from mend.server.limits import FixedLimitName, LimitName, Limits, SetLimitName
from mend.server.refusals import Refusals

RUN = {"tree": "eket", "world": "tabletop"}


def test_every_limit_that_can_be_set_can_be_named() -> None:
    assert set(get_args(SetLimitName)) == set(Limits.model_fields)


def test_every_fixed_limit_has_a_row_that_says_how_it_is_counted() -> None:
    documented = (Path(__file__).parents[2] / "docs" / "limits.md").read_text()
    _, table = documented.split("## That are fixed")
    named = re.findall(r"\| `(\w+)` \|$", table, re.MULTILINE)
    assert sorted(named) == sorted(get_args(FixedLimitName))


def test_refusals_are_counted_by_limit() -> None:
    refusals = Refusals()
    refusals.note("answers")
    refusals.note("departed_robots", 2)
    counts = dict(refusals.counts)
    assert (counts.pop("answers"), counts.pop("departed_robots")) == (1, 2)
    assert set(counts.values()) == {0}


async def test_what_is_refused_over_a_socket_is_counted_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with serving() as service:

        async def refuse(*_: Any, **__: Any) -> Any:
            raise ConflictError("this dialogue was claimed enough", limit="claims")

        monkeypatch.setattr(service.runs, "claim", refuse)
        claim = {"type": "claim", "id": 1, "dialogue": str(uuid4())}
        async with connect(f"{service.ws}?helper=anna") as socket, asyncio.timeout(60):
            await socket.recv()
            await socket.send(json.dumps(claim))
            assert json.loads(await socket.recv())["status"] == 409
        assert service.refusals.counts["claims"] == 1


async def test_sign_ins_without_end_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mend.server.access.sessions.SESSIONS_AN_HOUR", 1)
    service = build(token=TOKEN)
    async with service.client() as client:
        answers = [await client.post("/api/session", json={"token": TOKEN}) for _ in range(2)]
    service.journal.close()
    assert [each.status_code for each in answers] == [204, 429]
    assert 3500 < int(answers[1].headers["Retry-After"]) <= 3600
    assert service.refusals.counts["sign_ins"] == 1


async def test_metrics_have_a_counter_for_each_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    service = build()

    async def refuse(*_: Any) -> Any:
        raise ConflictError("two runs are enough", limit="running_runs")

    monkeypatch.setattr(service.runs, "start_run", refuse)
    async with service.client() as client:
        before = (await client.get("/metrics")).text
        response = await client.post("/api/runs", json=RUN)
        after = (await client.get("/metrics")).text
    service.journal.close()
    for name in get_args(LimitName):
        assert f'mend_refused_total{{limit="{name}"}} 0.0' in before
    assert (response.status_code, response.json()["detail"]) == (409, "two runs are enough")
    assert 'mend_refused_total{limit="running_runs"} 1.0' in after
    assert 'mend_refused_total{limit="answers"} 0.0' in after
