"""What other pages than that of the questions are refused is in every language of the console."""

from collections.abc import AsyncIterator
from typing import Any
from uuid import UUID

import httpx
import pytest
from languages_of_console import untold
from service_under_test import build

from mend.server.runtime.steering import effect_of
from mend.tasks.steering_rules import SteeringAct

FILES = ("clauses", "refusals")
NOBODY = UUID(int=7)


def sentences(response: httpx.Response) -> list[str]:
    """What the page shows of a refusal."""
    problem = response.json()
    assert response.is_client_error, problem
    return problem.get("errors") or [problem["detail"]]


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    service = build()
    async with service.client() as client:
        yield client
    service.journal.close()


@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("GET", f"/api/runs/{NOBODY}", None),
        ("POST", f"/api/runs/{NOBODY}/pause", None),
        ("POST", f"/api/runs/{NOBODY}/abort", None),
        ("POST", "/api/runs", {"tree": "eket", "seed": -1}),
        ("POST", "/api/runs", {"tree": "eket", "seed": 1.5}),
        ("POST", "/api/runs", {"tree": "eket", "max_attempts": 1000}),
        ("GET", "/api/trees/nope", None),
        ("DELETE", "/api/trees/nope", None),
        ("GET", "/api/scenes/nope", None),
        ("GET", f"/api/pictures/{NOBODY}", None),
        ("DELETE", f"/api/push/subscriptions/{NOBODY.hex}", None),
        ("GET", "/api/nowhere", None),
    ],
)
async def test_refusals_over_rest(
    client: httpx.AsyncClient, method: str, path: str, body: dict[str, Any] | None
) -> None:
    assert untold(sentences(await client.request(method, path, json=body)), FILES) == []


@pytest.mark.parametrize("leaf", [True, False])
@pytest.mark.parametrize("act", SteeringAct)
def test_what_comes_of_steering(act: SteeringAct, leaf: bool) -> None:
    assert untold([effect_of(act, leaf=leaf)], FILES) == []
