"""Requests that follow the OpenAPI's links one after the other: no 5xx, and only what it says."""

from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest
import schemathesis
from fake_runs import FakeRuns
from hypothesis import HealthCheck, Phase, seed, settings
from hypothesis.errors import FlakyStrategyDefinition
from hypothesis.stateful import run_state_machine_as_test
from plain_problems import told_plainly
from sampled import sample
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from service_under_test import TOKEN, ServiceUnderTest, build

from mend.server.api.openapi_links import LINKS
from mend.server.app import described_app
from mend.server.journal.events import Author
from mend.server.limits import Limits
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunView

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
    told_plainly,
]


WAY = [
    "list_trees", "upload_tree", "get_tree", "delete_tree", "start_run", "get_run", "pause_run",
    "resume_run", "abort_run", "intervene", "list_events", "list_dialogues", "get_dialogue",
    "answer_prompt", "claim_dialogue", "release_dialogue", "extend_deadline", "get_picture",
]  # fmt: skip
"""From an upload to a run, its question and its end."""

BEHIND_A_RUN = set(WAY[WAY.index("get_run") :]) - {"list_dialogues"}
"""What has to be given the id of a run, of its dialogue or of a picture."""

FEWEST, MOST = sample((2, 8), (8, 8))
"""So many machines go on, more than the fewest only until enough was reached."""


class TroubledRuns(FakeRuns):
    """Every run asks for help at once, so that there is a dialogue to go on with."""

    async def start_run(self, request: RunRequest, author: Author | None = None) -> RunView:
        run = await super().start_run(request, author)
        await self.raise_issue(run.id)
        return self.run_now(run.id)


@pytest.fixture
def service() -> Iterator[ServiceUnderTest]:
    # Whoever guesses has to wait, and everybody comes from one address here.
    limits = Limits(wrong_tokens=2**31 - 1)
    service = build(allowed_hosts=["testserver"], runs_in=TroubledRuns, token=TOKEN, limits=limits)
    yield service
    service.journal.close()


@pytest.mark.slow(6)
def test_requests_in_turn_end_in_answers_that_are_documented(service: ServiceUnderTest) -> None:
    reached: set[tuple[str, int]] = set()
    whole = schemathesis.openapi.from_asgi("/openapi.json", service.app)
    # The fewer doors there are, the deeper it gets behind them.
    machine = whole.include(operation_id=WAY).as_state_machine()

    class Watched(machine):  # type: ignore[misc, valid-type]
        def get_call_kwargs(self, case: Any) -> dict[str, Any]:  # noqa: ARG002
            return {"headers": {"Authorization": f"Bearer {TOKEN}"}}

        def validate_response(self, response: Any, case: Any, **_: Any) -> None:
            reached.add((case.operation.definition.raw["operationId"], response.status_code))
            case.validate_response(response, checks=CHECKS)

    for number in range(MOST):
        if number >= FEWEST and "start_run" in done(reached) and went_on(reached):
            break
        # The service remembers, so that no two machines find it alike, as hypothesis would have it.
        with suppress(FlakyStrategyDefinition):
            run_state_machine_as_test(
                seed(number)(Watched),
                settings=settings(
                    max_examples=8, stateful_step_count=20, deadline=None, database=None,
                    phases=[Phase.generate], suppress_health_check=list(HealthCheck),
                ),
            )  # fmt: skip
    assert "start_run" in done(reached), sorted(reached)
    assert went_on(reached), sorted(reached)


def done(reached: set[tuple[str, int]]) -> set[str]:
    return {operation for operation, status in reached if status < 300}


def went_on(reached: set[tuple[str, int]]) -> bool:
    """Which of them depends on the numbers of the runs, that are drawn anew each time."""
    return len(done(reached) & BEHIND_A_RUN) >= 2


def test_every_link_names_an_operation_and_parameters_that_there_are() -> None:
    paths = described_app().openapi()["paths"]
    operations = {
        each["operationId"]: each for methods in paths.values() for each in methods.values()
    }
    for (operation, status), links in LINKS.items():
        answer = operations[operation]["responses"][status]
        assert answer["links"].keys() == {each.operation for each in links}
        for link in links:
            known = {each["name"] for each in operations[link.operation].get("parameters", [])}
            assert set(link.parameters) <= known, (operation, link.operation)
            needed = {
                each["name"]
                for each in operations[link.operation].get("parameters", [])
                if each.get("required")
            }
            assert needed <= set(link.parameters), (operation, link.operation)


def test_every_answer_that_any_operation_may_give_is_documented() -> None:
    for path, methods in described_app().openapi()["paths"].items():
        for operation in methods.values():
            answers = operation["responses"]
            assert {"413", "421", "500", "503"} <= answers.keys(), path
            for status in answers:
                if int(status) >= 400:
                    content = answers[status]["content"]["application/problem+json"]
                    assert content["schema"] == {"$ref": "#/components/schemas/Problem"}, path
