"""Runs, dialogues and what goes with them over REST; documents: `test_documents_over_rest.py`."""

import errno
import os
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pytest
from people import People
from service_under_test import ServiceUnderTest, build

from mend.server.access.roles import Role
from mend.server.journal import events as ev
from mend.server.journal.run_index import RunPage
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunSummary, RunView
from mend.tasks.library import SCENARIOS

# Fixed, so that every worker collects the same tests.
NOBODY = "2dc8e3f6-6479-4c12-9baf-d2534d0b7e34"

REQUEST = RunRequest(tree="eket", world="tabletop", speed="max")
EKET = {"tree": "eket", "world": "tabletop", "speed": "max", "seed": 7}


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    service = build()
    yield service
    service.journal.close()


@pytest.fixture
async def client(service: ServiceUnderTest) -> AsyncIterator[httpx.AsyncClient]:
    async with service.client() as client:
        yield client


def problem_in(response: httpx.Response) -> Any:
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert problem["status"] == response.status_code
    assert problem["title"]
    assert problem["detail"]
    return problem


async def start(client: httpx.AsyncClient) -> str:
    response = await client.post("/api/runs", json=EKET)
    assert response.status_code == 201
    return str(response.json()["id"])


async def test_run_is_started_listed_and_read(client: httpx.AsyncClient) -> None:
    response = await client.post("/api/runs", json=EKET)
    assert response.status_code == 201
    run = response.json()
    assert response.headers["location"] == f"/api/runs/{run['id']}"
    assert run["status"] == "running"
    assert [each["id"] for each in (await client.get("/api/runs")).json()] == [run["id"]]
    assert (await client.get(f"/api/runs/{run['id']}")).json()["nodes"][0]["name"] == "pink_bar"


async def test_lists_come_in_pages(client: httpx.AsyncClient) -> None:
    runs = [await start(client) for _ in range(3)]
    page = await client.get("/api/runs", params={"limit": 1, "offset": 1})
    assert [each["id"] for each in page.json()] == [runs[1]]
    assert (await client.get("/api/runs", params={"limit": 0})).status_code == 422
    assert (await client.get("/api/runs", params={"limit": 1001})).status_code == 422


async def test_runs_are_listed_by_their_state(client: httpx.AsyncClient) -> None:
    going, paused, aborted = [await start(client) for _ in range(3)]
    await client.post(f"/api/runs/{paused}/pause")
    await client.post(f"/api/runs/{aborted}/abort")

    async def listed(*statuses: str) -> list[str]:
        page = await client.get("/api/runs", params={"status": statuses})
        return [run["id"] for run in page.json()]

    assert await listed("running") == [going]
    assert await listed("running", "aborted") == [aborted, going]
    assert await listed("finished") == []
    assert (await client.get("/api/runs", params={"status": "lost"})).status_code == 422


async def test_run_is_paused_resumed_and_aborted(client: httpx.AsyncClient) -> None:
    run = await start(client)
    assert (await client.post(f"/api/runs/{run}/pause")).json()["status"] == "paused"
    again = await client.post(f"/api/runs/{run}/pause")
    assert again.status_code == 409
    assert "paused" in problem_in(again)["detail"]
    assert (await client.post(f"/api/runs/{run}/resume")).json()["status"] == "running"
    assert (await client.post(f"/api/runs/{run}/abort")).json()["status"] == "aborted"
    assert (await client.post(f"/api/runs/{run}/resume")).status_code == 409


@pytest.mark.parametrize(
    ("change", "status"),
    [
        ({"tree": "nowhere"}, 404),
        ({"scenario": "nowhere"}, 404),
        ({"world": "moon"}, 422),
        ({"seed": True}, 422),
        ({"seed": "7"}, 422),
        ({"seed": -1}, 422),
        ({"seed": 10**30}, 422),
        ({"world_options": {"noise": 2**53}}, 422),
        ({"speed": 0}, 422),
        ({"speed": "fast"}, 422),
        ({"unknown": 1}, 422),
        ({"tree": ""}, 422),
        ({"answers": ["perhaps"]}, 422),
    ],
)
async def test_wrong_run_request_starts_nothing(
    client: httpx.AsyncClient, change: dict[str, Any], status: int
) -> None:
    response = await client.post("/api/runs", json={**EKET, **change})
    assert response.status_code == status
    problem = problem_in(response)
    if status == 422:
        assert problem["errors"]
    assert (await client.get("/api/runs")).json() == []


@pytest.mark.parametrize(
    ("body", "status"),
    [
        (b"", 422),
        (b"{", 422),
        (b"[]", 422),
        (b"null", 422),
        (b"\xff\xfe{}", 400),
        (b'{"tree": "\\u0000"}', 404),
        (b'{"tree": "\\ud800"}', 422),
        (b'{"\\ud800": 1}', 422),
        (b'{"tree": "eket", "seed": 1' + b"0" * 6000 + b"}", 400),
        (b'{"tree": "eket", "world_options": {"noise": NaN}}', 400),
        (b'{"tree": "eket", "speed": 1e999}', 400),
        (b'{"tree": "eket", "world_options": {"noise": 1e999}}', 400),
        (b"[" * 100_000, 400),
    ],
)
async def test_body_that_is_no_good_json_is_a_problem(
    client: httpx.AsyncClient, body: bytes, status: int
) -> None:
    headers = {"content-type": "application/json"}
    response = await client.post("/api/runs", content=body, headers=headers)
    assert response.status_code == status
    problem_in(response)
    assert (await client.get("/api/runs")).json() == []


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            {"max_attempts": 101},
            "body.max_attempts: must be less than or equal to 100, but it is 101",
        ),
        (
            {"person": {"delay_s": 5000}},
            "body.person.delay_s: must be less than or equal to 3600 (in seconds), but it is 5000",
        ),
        (
            {"speed": 2000},
            "body.speed: must be less than or equal to 1000 or 'max', but it is 2000",
        ),
        ({"tree": "t" * 65}, "body.tree: must have at most 64 characters"),
        ({"robots": ["r"] * 65}, "body.robots: must have at most 64 entries, but it has 65"),
        ({"answers": 7}, "body.answers: must be a list or 'random', 'none' or 'live', but it is 7"),
        ({"sped": 1}, "body.sped: is not known here"),
    ],
)
async def test_what_is_wrong_in_a_body_is_told_with_its_field_what_is_right_and_what_came(
    client: httpx.AsyncClient, change: dict[str, Any], sentence: str
) -> None:
    response = await client.post("/api/runs", json={**EKET, **change})
    assert problem_in(response)["errors"] == [sentence]


async def test_what_is_wrong_in_an_address_is_told_with_its_parameter(
    client: httpx.AsyncClient,
) -> None:
    response = await client.get("/api/runs", params={"limit": 5000})
    assert problem_in(response)["detail"] == (
        'query.limit: must be less than or equal to 1000, but it is "5000"'
    )


async def test_a_body_that_is_not_json_or_lacks_a_field_is_told(client: httpx.AsyncClient) -> None:
    headers = {"content-type": "application/json"}
    response = await client.post("/api/runs", content=b"{", headers=headers)
    assert problem_in(response)["detail"].startswith("body: is not JSON: ")
    response = await client.post("/api/runs", content=b"{")
    assert problem_in(response)["detail"] == (
        "body: must be JSON that is sent with 'Content-Type: application/json'"
    )
    response = await client.post("/api/runs", json={})
    assert problem_in(response)["detail"] == "body.tree: is missing"


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nowhere", 404),
        ("GET", "/api/nowhere", 404),
        ("DELETE", "/api/runs", 405),
        ("PUT", "/healthz", 405),
        ("GET", f"/api/runs/{NOBODY}", 404),
        ("GET", "/api/runs/7", 422),
        ("POST", f"/api/runs/{NOBODY}/pause", 404),
        ("GET", f"/api/runs/{NOBODY}/events", 404),
        ("GET", f"/api/runs/{NOBODY}/cameras/head", 404),
        ("GET", f"/api/pictures/{NOBODY}", 404),
        ("GET", f"/api/dialogues/{NOBODY}", 404),
        ("GET", "/api/dialogues?status=ajar", 422),
        ("GET", "/api/trees/nowhere", 404),
        ("GET", "/assets/../app.py", 404),
    ],
)
async def test_every_refusal_is_a_problem_document(
    client: httpx.AsyncClient, method: str, path: str, status: int
) -> None:
    response = await client.request(method, path)
    assert response.status_code == status
    problem_in(response)


async def test_events_are_read_after_a_number(client: httpx.AsyncClient) -> None:
    run = await start(client)
    other = await start(client)
    await client.post(f"/api/runs/{run}/pause")
    events = (await client.get(f"/api/runs/{run}/events")).json()
    assert [event["type"] for event in events] == ["run_started", "run_paused"]
    assert [event["seq"] for event in events] == [1, 3]
    after = await client.get(f"/api/runs/{run}/events", params={"after": 1, "limit": 5})
    assert [event["seq"] for event in after.json()] == [3]
    assert (await client.get(f"/api/runs/{other}/events", params={"after": 2})).json() == []
    huge = await client.get(f"/api/runs/{run}/events", params={"after": 2**63})
    assert huge.status_code == 422


async def test_second_answer_is_told_who_was_first(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    run = await start(client)
    await service.runs.raise_issue((await service.runs.snapshot(None)).runs[0].id)
    (dialogue,) = (await client.get("/api/dialogues", params={"status": "open"})).json()
    assert dialogue["run"] == run
    path = f"/api/dialogues/{dialogue['dialogue']}/answers"
    answer = {"prompt": dialogue["prompt"]["prompt"], "answer": "yes", "helper": "anna"}
    first = await client.post(path, json=answer)
    assert first.status_code == 201
    assert first.json()["helper"] == "anna"
    second = await client.post(path, json={**answer, "helper": "ben"})
    assert second.status_code == 409
    assert problem_in(second)["answered_by"] == "anna"
    assert (await client.get("/api/dialogues", params={"status": "open"})).json() == []


@pytest.mark.parametrize(
    "change",
    [
        {"answer": "maybe"},
        {"answer": True},
        {"prompt": "7"},
        {"prompt": 7},
        {"helper": ""},
        {"helper": "a\x00b"},
        {"helper": "x" * 65},
        {"helper": None},
    ],
)
async def test_wrong_answer_changes_nothing(
    client: httpx.AsyncClient, service: ServiceUnderTest, change: dict[str, Any]
) -> None:
    await start(client)
    view = await service.runs.raise_issue((await service.runs.snapshot(None)).runs[0].id)
    assert view.prompt is not None
    answer = {"prompt": str(view.prompt.prompt), "answer": "yes", "helper": "anna", **change}
    head = service.journal.head
    response = await client.post(f"/api/dialogues/{view.dialogue}/answers", json=answer)
    assert response.status_code == 422
    assert problem_in(response)["errors"]
    assert service.journal.head == head


async def test_claim_is_exclusive_until_released(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    await start(client)
    view = await service.runs.raise_issue((await service.runs.snapshot(None)).runs[0].id)
    path = f"/api/dialogues/{view.dialogue}"
    claimed = await client.post(f"{path}/claim", json={"helper": "anna"})
    assert claimed.json()["claimed_by"] == "anna"
    assert (await client.post(f"{path}/claim", json={"helper": "ben"})).status_code == 409
    assert (await client.post(f"{path}/release", json={"helper": "anna"})).status_code == 200
    assert (await client.post(f"{path}/claim", json={"helper": "ben"})).status_code == 200


async def test_intervention_is_checked_and_done(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    run = await start(client)
    path = f"/api/runs/{run}/interventions"
    done = await client.post(path, json={"act": "steal", "object": "pink_bar"})
    assert done.status_code == 201
    for wrong in ({"act": "steal"}, {"act": "eat", "object": "x"}, {"act": "move", "object": "x"}):
        assert (await client.post(path, json=wrong)).status_code == 422
    assert service.journal.head == 3


async def test_camera_picture_is_a_jpeg(client: httpx.AsyncClient) -> None:
    run = await start(client)
    picture = await client.get(f"/api/runs/{run}/cameras/head")
    assert picture.headers["content-type"] == "image/jpeg"
    assert picture.content.startswith(b"\xff\xd8")
    assert (await client.get(f"/api/runs/{run}/cameras/foot")).status_code == 404


async def test_body_above_the_limit_is_refused(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    yaml = {"content-type": "application/yaml"}
    declared = await client.post("/api/trees", content=b"then" * (3 * 1024**2), headers=yaml)
    assert declared.status_code == 413
    problem_in(declared)

    async def endless() -> AsyncIterator[bytes]:
        for _ in range(12):
            yield b"then" * (256 * 1024)

    streamed = await client.post("/api/trees", content=endless(), headers=yaml)
    assert streamed.status_code == 413
    problem_in(streamed)
    assert service.refusals.counts["body_bytes"] == 2


async def test_health_scenarios_robots_and_metrics(client: httpx.AsyncClient) -> None:
    await start(client)
    assert (await client.get("/healthz")).json() == {"status": "ok"}
    ready = (await client.get("/readyz")).json()
    counts = {"unreadable_runs": 0, "unreadable_events": 0, "damaged": 0}
    assert ready == {"status": "ok", **counts, "damage": []}
    scenarios = (await client.get("/api/scenarios")).json()
    assert [each["name"] for each in scenarios] == SCENARIOS.names()
    assert all(each["built_in"] and each["tree"] == "eket" for each in scenarios)
    assert (await client.get("/api/robots")).json()[0]["robot"] == "robot"
    metrics = (await client.get("/metrics")).text
    assert 'mend_runs{status="running"} 1.0' in metrics
    assert "mend_events_total 1.0" in metrics
    assert "mend_journal_commit_seconds_count 1.0" in metrics


async def test_readiness_is_a_problem_once_the_journal_is_closed(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    service.journal.close()
    response = await client.get("/readyz")
    assert response.status_code == 503
    problem_in(response)
    assert (await client.get("/healthz")).status_code == 200


async def test_readiness_says_why_the_journal_cannot_be_written(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    service.journal.trouble.began("the journal could not be written: disk is full")
    response = await client.get("/readyz")
    assert response.status_code == 503
    assert problem_in(response)["detail"] == "the journal could not be written: disk is full"
    assert "mend_journal_writable 0.0" in (await client.get("/metrics")).text
    service.journal.trouble.ended(probed=True)
    assert (await client.get("/readyz")).status_code == 200


async def test_readiness_tells_strangers_and_robots_not_why(tmp_path: Path) -> None:
    people = People(tmp_path)
    service, why = build(principals=people.file), "/home/mend/journal.db was deleted"
    # Without a try to write, which would end the trouble.
    service.journal.trouble.reason = why
    for headers in ({}, people.headers(Role.ROBOT)):
        async with service.client(headers=headers) as client:
            response = await client.get("/readyz")
        assert response.status_code == 503
        assert problem_in(response)["detail"] == "the journal cannot be read or written"
    async with service.client(headers=people.headers(Role.VIEWER)) as client:
        told = await client.get("/readyz")
    service.journal.close()
    assert (told.status_code, problem_in(told)["detail"]) == (503, why)


async def test_an_abort_that_is_not_kept_yet_is_accepted(
    client: httpx.AsyncClient, service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = await start(client)

    async def stop(run: UUID, author: ev.Author) -> RunView:  # noqa: ARG001
        return service.runs.run_now(run)

    monkeypatch.setattr(service.runs, "abort", stop)
    response = await client.post(f"/api/runs/{run}/abort")
    assert response.status_code == 202
    assert response.json()["status"] == "running"


async def test_answers_say_what_they_are_and_are_kept_by_nobody(client: httpx.AsyncClient) -> None:
    for path, status in (("/api/runs", 200), ("/api/nothing", 404)):
        response = await client.get(path)
        assert response.status_code == status
        assert response.headers["x-content-type-options"] == "nosniff"
        assert response.headers["cache-control"] == "no-store"
    assert (await client.get("/healthz")).headers["x-content-type-options"] == "nosniff"


async def test_openapi_names_every_operation_and_has_examples(client: httpx.AsyncClient) -> None:
    schema = (await client.get("/openapi.json")).json()
    operations = [operation for path in schema["paths"].values() for operation in path.values()]
    names = [operation["operationId"] for operation in operations]
    assert len(set(names)) == len(names)
    assert all("description" in operation for operation in operations)
    body = schema["paths"]["/api/runs"]["post"]["requestBody"]["content"]["application/json"]
    assert body["schema"]["examples"] or body["examples"]
    assert "Problem" in schema["components"]["schemas"]
    references = {text.split('"')[0] for text in str(schema).split("#/components/schemas/")[1:]}
    names_used = {each.split("'")[0] for each in references}
    assert names_used <= set(schema["components"]["schemas"])


# --- What the console chooses from -------------------------------------------------------------


async def test_worlds_say_why_they_cannot_run(client: httpx.AsyncClient) -> None:
    tabletop, workcell = (await client.get("/api/worlds")).json()
    assert tabletop == {
        "name": "tabletop",
        "available": True,
        "reason": None,
        "options": {},
    }
    assert workcell["available"] is False
    assert workcell["reason"]


async def test_more_time_and_taking_over_are_asked_for_over_rest(
    service: ServiceUnderTest, client: httpx.AsyncClient
) -> None:
    view = await service.runs.raise_issue((await service.runs.start_run(REQUEST)).id)
    assert view.prompt is not None
    path = f"/api/dialogues/{view.dialogue}"
    body = {"prompt": str(view.prompt.prompt), "helper": "anna"}
    extended = await client.post(f"{path}/extend", json=body)
    assert extended.status_code == 200
    assert extended.json()["type"] == "deadline_extended"
    assert extended.json()["extensions_left"] == 9
    assert (await client.post(f"{path}/extend", json={**body, "prompt": NOBODY})).status_code == 404
    assert (await client.post(f"{path}/claim", json={"helper": "anna"})).is_success
    assert (await client.post(f"{path}/claim", json={"helper": "ben"})).status_code == 409
    taken = await client.post(f"{path}/claim", json={"helper": "ben", "take_over": True})
    assert taken.json()["claimed_by"] == "ben"


async def test_a_word_on_promised_help_is_taken_over_rest_and_refused_where_none_is_awaited(
    service: ServiceUnderTest, client: httpx.AsyncClient
) -> None:
    view = await service.runs.raise_issue((await service.runs.start_run(REQUEST)).id)
    path = f"/api/dialogues/{view.dialogue}"
    for word in ("done", "take_back"):
        refused = await client.post(f"{path}/{word}", json={"helper": "anna"})
        assert refused.status_code == 409
        assert "no help is awaited" in refused.json()["detail"]
    await service.runs.await_help(view.dialogue, "anna")
    said = await client.post(f"{path}/done", json={"helper": "ben"})
    assert said.status_code == 200
    assert (said.json()["type"], said.json()["helper"]) == ("help_reported", "ben")
    assert (await client.get(path)).json()["help"]["reported_by"] == "ben"
    assert (await client.post(f"{path}/take_back", json={"helper": "ben"})).status_code == 409
    taken_back = await client.post(f"{path}/take_back", json={"helper": "anna"})
    assert taken_back.json()["type"] == "promise_taken_back"
    assert (await client.get(path)).json()["help"] is None


async def test_poses_of_a_run_that_showed_nothing_are_empty_and_of_no_run_not_found(
    client: httpx.AsyncClient,
) -> None:
    run = await start(client)
    poses = await client.get(f"/api/runs/{run}/poses")
    assert (poses.status_code, poses.content) == (200, b"")
    assert "mend-poses-span" not in poses.headers
    assert (await client.get(f"/api/runs/{run}/layout")).status_code == 404
    assert (await client.get(f"/api/runs/{NOBODY}/poses")).status_code == 404
    assert (await client.get(f"/api/runs/{run}/poses?from_s=nan")).status_code == 422


@pytest.mark.parametrize(
    ("number", "status"), [(errno.EMFILE, 503), (errno.ENFILE, 503), (errno.EIO, 500)]
)
async def test_without_a_file_descriptor_the_client_is_asked_to_try_again(
    service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch, number: int, status: int
) -> None:
    async def fail(_page: RunPage) -> list[RunSummary]:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(service.runs, "runs", fail)
    async with service.client() as client:
        response = await client.get("/api/runs")
    assert response.status_code == status
    problem_in(response)
    assert ("retry-after" in response.headers) is (status == 503)
