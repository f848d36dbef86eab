"""What is beyond a limit is counted by that limit, and Prometheus may know it."""

from typing import Any, get_args

import pytest
from service_under_test import build

from server.errors import ConflictError
from server.limits import LimitName, Limits
from server.refusals import Refusals

RUN = {"tree": "eket", "world": "tabletop"}


def test_every_limit_can_be_named() -> None:
    assert set(get_args(LimitName)) == set(Limits.model_fields)


def test_refusals_are_counted_by_limit() -> None:
    refusals = Refusals()
    refusals.note("answers")
    refusals.note("departed_robots", 2)
    counts = dict(refusals.counts)
    assert (counts.pop("answers"), counts.pop("departed_robots")) == (1, 2)
    assert set(counts.values()) == {0}


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
    for name in Limits.model_fields:
        assert f'mend_refused_total{{limit="{name}"}} 0.0' in before
    assert (response.status_code, response.json()["detail"]) == (409, "two runs are enough")
    assert 'mend_refused_total{limit="running_runs"} 1.0' in after
    assert 'mend_refused_total{limit="answers"} 0.0' in after
