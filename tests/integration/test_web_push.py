"""A live question reaches the devices of those who are asked, over a real push service."""

import asyncio
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from push_endpoint import PushDevice, PushService, push_service, signed_claims

from mend.server.composition import Service, open_service
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings

ASKS = RunRequest(
    tree="eket", world="tabletop", speed="max", scenario="eket_paper", answers="live", seed=7
)


@pytest.fixture
def pushes() -> Iterator[PushService]:
    with push_service() as service:
        yield service


def settings(folder: Path, **more: Any) -> Settings:
    return Settings(
        port=0, data_dir=folder, speech_voice="none", log_level="error",
        push_services=["127.0.0.1"], **more,
    )  # fmt: skip


async def until(true: Callable[[], bool]) -> None:
    async with asyncio.timeout(120):
        while not true():  # noqa: ASYNC110 - the push service is in a thread
            await asyncio.sleep(0.01)


async def subscribe(client: httpx.AsyncClient, device: PushDevice, helper: str) -> dict[str, Any]:
    body = {**device.subscription, "helper": helper}
    answer = await client.post("/api/push/subscriptions", json=body)
    assert answer.status_code == 201, answer.text
    view: dict[str, Any] = answer.json()
    return view


async def the_open_question(service: Service) -> Any:
    async with asyncio.timeout(120):
        while True:
            for each in await service.runtime.dialogues.page("open", 10, 0):
                if each.awaiting == "answer":
                    return each
            await asyncio.sleep(0.01)


@pytest.mark.slow(seconds=6)
async def test_a_question_calls_who_is_asked_and_an_answer_calls_it_off(
    tmp_path: Path, pushes: PushService
) -> None:
    phone, tablet = PushDevice(pushes, "phone"), PushDevice(pushes, "tablet")
    async with (
        open_service(settings(tmp_path, helpers=["anna", "ben"])) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        await subscribe(client, phone, "anna")
        await subscribe(client, tablet, "ben")
        view = (await client.get("/api/push", params={"helper": "carl"})).json()
        assert (view["available"], view["asked"]) == (True, False)
        helping = (await client.get("/api/helpers")).json()
        assert [each["reach"] for each in helping["helpers"]] == ["called", "called"]
        run = await service.runtime.start_run(ASKS)
        question = await the_open_question(service)
        await until(lambda: bool(pushes.pushed))
        [call] = pushes.of(phone)
        assert (call.type, call.text) == ("call", question.prompt.text)
        assert (call.dialogue, call.run) == (question.dialogue, run.id)
        assert pushes.of(tablet) == []
        claims = signed_claims(pushes.pushed[0], view["key"])
        assert 0 < claims["exp"] - time.time() <= 24 * 3600
        await service.runtime.dialogues.claim(question.dialogue, "ben")
        await until(lambda: len(pushes.of(phone)) == 2)
        assert (pushes.of(phone)[1].type, pushes.of(phone)[1].text) == (
            "withdrawn", "ben is on it.",
        )  # fmt: skip
        await service.runtime.dialogues.release(question.dialogue, "ben")
        await until(lambda: len(pushes.of(phone)) == 3)
        assert pushes.of(phone)[2] == call
        await service.runtime.abort(run.id)
        await until(lambda: len(pushes.of(phone)) == 4)
        withdrawn = pushes.of(phone)[3]
        assert (withdrawn.type, withdrawn.dialogue) == ("withdrawn", question.dialogue)
        assert pushes.of(tablet) == []


@pytest.mark.slow(seconds=4)
async def test_a_scripted_run_calls_nobody(tmp_path: Path, pushes: PushService) -> None:
    phone = PushDevice(pushes, "phone")
    async with (
        open_service(settings(tmp_path)) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        await subscribe(client, phone, "anna")
        scripted = ASKS.model_copy(update={"answers": None})
        run = await service.runtime.start_run(scripted)
        await service.runtime.wait_for_end(run.id)
        events = await service.journal.read(0, 10_000, run.id)
    assert any(vars(each)["type"] == "answered" for each in events)
    assert pushes.pushed == []


@pytest.mark.slow(seconds=3)
async def test_a_device_is_tried_out_kept_and_ended(tmp_path: Path, pushes: PushService) -> None:
    phone = PushDevice(pushes, "phone")
    async with (
        open_service(settings(tmp_path)) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        key = (await client.get("/api/push")).json()["key"]
        answer = await client.post(
            "/api/push/subscriptions", json={**phone.subscription, "helper": "anna"}
        )
        device = answer.json()["id"]
        assert "endpoint" not in answer.json()
    async with (
        open_service(settings(tmp_path)) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        assert (await client.get("/api/push")).json()["key"] == key
        assert [each["id"] for each in (await client.get("/api/push/subscriptions")).json()] == [
            device
        ]
        trial = await client.post(f"/api/push/subscriptions/{device}/trial", json={"nonce": "n1"})
        assert trial.json() == {"outcome": "taken", "why": ""}
        assert [each.nonce for each in pushes.of(phone)] == ["n1"]
        pushes.statuses[phone.path] = [410]
        trial = await client.post(f"/api/push/subscriptions/{device}/trial", json={"nonce": "n2"})
        assert trial.json()["outcome"] == "gone"
        assert (await client.get("/api/push/subscriptions")).json() == []
        assert (await client.delete(f"/api/push/subscriptions/{device}")).status_code == 404


async def test_what_no_push_can_be_sent_to_is_refused_with_a_sentence(
    tmp_path: Path, pushes: PushService
) -> None:
    good = {**PushDevice(pushes, "phone").subscription, "helper": "anna"}
    wrong = [
        ({"endpoint": "https://192.168.1.1/admin"}, "none of the setting 'push_services'"),
        ({"keys": {**good["keys"], "auth": "AAAA"}}, "'auth' must be 16 bytes"),
        ({"device": ""}, "device"),
    ]
    async with (
        open_service(settings(tmp_path)) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        for changes, why in wrong:
            answer = await client.post("/api/push/subscriptions", json={**good, **changes})
            assert answer.status_code == 422
            assert why in answer.text
    async with (
        open_service(settings(tmp_path).model_copy(update={"push_services": []})) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        assert (await client.get("/api/push")).json()["available"] is False
        answer = await client.post("/api/push/subscriptions", json=good)
        assert (answer.status_code, "'push_services' is empty" in answer.text) == (503, True)
