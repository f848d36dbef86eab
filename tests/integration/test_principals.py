"""People and robots with credentials of their own, at a real service over real sockets."""

import asyncio
import json
from collections.abc import AsyncIterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pytest
from full_disk import failing
from people import NAMES, People, serving_people
from service_under_test import TOKEN, ServiceUnderTest, serving, until
from shown_run import hello, run_state
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidStatus

from mend.server.access.deeds import audit_of
from mend.server.access.principals_file import read_principals
from mend.server.access.roles import Role
from mend.server.access.sessions import SESSION_LIFETIME_S
from mend.server.client import MendClient
from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.limits import Limits
from mend.server.settings import Settings

Served = tuple[ServiceUnderTest, People]
RUN = {"tree": "eket", "world": "tabletop"}


@pytest.fixture
async def served(tmp_path: Path) -> AsyncIterator[Served]:
    async with serving_people(tmp_path) as served:
        yield served


def as_a(served: Served, role: Role) -> httpx.AsyncClient:
    service, people = served
    return httpx.AsyncClient(base_url=service.url, headers=people.headers(role))


async def message(socket: ClientConnection) -> Any:
    async with asyncio.timeout(60):
        return json.loads(await socket.recv())


async def close_code(socket: ClientConnection) -> int | None:
    async with asyncio.timeout(60):
        await socket.wait_closed()
    return socket.close_code


async def sign_in(client: httpx.AsyncClient, token: str) -> str:
    answer = await client.post("/api/session", json={"token": token})
    assert answer.status_code == 204
    return client.cookies["mend_session"]


async def with_cookie(service: ServiceUnderTest, cookie: str) -> int:
    async with httpx.AsyncClient(base_url=service.url) as client:
        headers = {"Cookie": f"mend_session={cookie}"}
        return (await client.get("/api/runs", headers=headers)).status_code


async def test_who_asks_without_end_is_answered_at_a_pace_and_nobody_else_waits(
    tmp_path: Path,
) -> None:
    async with serving_people(tmp_path, limits=Limits(requests_per_s=1)) as served:
        service, _ = served
        async with as_a(served, Role.ROBOT) as flooding, as_a(served, Role.HELPER) as other:
            # Also what is refused, and over however many connections.
            many = [asyncio.create_task(flooding.get("/api/runs")) for _ in range(60)]
            await service.refused("requests_per_s")
            assert (await other.get("/api/runs")).status_code == 200
            answers = await asyncio.gather(*many)
    refused = [each for each in answers if each.status_code == 429]
    assert {each.status_code for each in answers} == {403, 429}
    assert all(int(each.headers["Retry-After"]) >= 4 for each in refused)
    assert "requests_per_s" in refused[0].json()["detail"]


async def at_once(_: float) -> None:
    """The clock stands still: who has to wait goes on at once."""


STILL: dict[str, Any] = {"now": lambda: 0.0, "sleep": at_once, "limits": Limits(requests_per_s=1)}
ANSWERED = 8
"""Four seconds' worth at once, and as many that wait."""


@pytest.mark.parametrize("path", ["/api/session", "/healthz", "/readyz", "/"])
async def test_who_says_who_they_are_has_their_pace_at_open_doors_too(
    tmp_path: Path, path: str
) -> None:
    async with serving_people(tmp_path, **STILL) as served:
        service, _ = served
        async with as_a(served, Role.VIEWER) as viewer, as_a(served, Role.HELPER) as other:
            statuses = [(await viewer.get(path)).status_code for _ in range(ANSWERED + 2)]
            assert (await other.get(path)).status_code == 200
        async with httpx.AsyncClient(base_url=service.url) as stranger:
            assert (await stranger.get(path)).status_code == 200
    assert statuses == [200] * ANSWERED + [429] * 2


async def opened(served: Served) -> int:
    """What somebody is answered who opens a socket."""
    service, people = served
    try:
        async with connect(service.ws, additional_headers=people.headers(Role.VIEWER)) as socket:
            assert (await message(socket))["type"] == "snapshot"
    except InvalidStatus as refused:
        return refused.response.status_code
    return 200


async def opened_by_a_message(served: Served) -> int:
    """What they are answered who show their token in the first message."""
    service, people = served
    async with connect(service.ws) as socket:
        await socket.send(json.dumps({"type": "auth", "token": people.tokens[Role.VIEWER]}))
        answer = await message(socket)
        if answer["type"] == "snapshot":
            return 200
        assert await close_code(socket) == 1013
    status: int = answer["status"]
    return status


@pytest.mark.parametrize("opening", [opened, opened_by_a_message])
async def test_to_open_sockets_is_to_ask_too(tmp_path: Path, opening: Any) -> None:
    async with serving_people(tmp_path, **STILL) as served:
        statuses = [await opening(served) for _ in range(ANSWERED + 1)]
        assert served[0].refusals.counts["requests_per_s"] == 5
        async with as_a(served, Role.VIEWER) as viewer:
            assert (await viewer.get("/api/runs")).status_code == 429
    assert statuses == [200] * ANSWERED + [429]


@pytest.mark.parametrize("path", ["/api/runs", "/ws/helper"])
async def test_who_is_revoked_while_they_have_to_wait_is_not_let_in(
    tmp_path: Path, path: str
) -> None:
    waited: list[float] = []

    async def revoked_meanwhile(seconds: float) -> None:
        served[1].revoke(Role.OPERATOR)
        waited.append(seconds)

    settings = {**STILL, "sleep": revoked_meanwhile}
    async with serving_people(tmp_path, **settings) as served, as_a(served, Role.OPERATOR) as olga:
        for _ in range(4):
            assert (await olga.get("/api/runs")).status_code == 200
        if path == "/api/runs":
            assert (await olga.post(path, json=RUN)).status_code == 401
        else:
            with pytest.raises(InvalidStatus):
                await connect(
                    served[0].ws,
                    additional_headers={"Authorization": olga.headers["Authorization"]},
                )
        assert len(waited) == 1
        assert served[0].journal.head == 0


# --- Sessions -------------------------------------------------------------------------------------


async def test_a_cookie_that_was_signed_out_opens_nothing_wherever_it_was_copied_to() -> None:
    async with (
        serving(token=TOKEN) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        copied = await sign_in(client, TOKEN)
        assert await with_cookie(service, copied) == 200
        assert (await client.delete("/api/session")).status_code == 204
        assert await with_cookie(service, copied) == 401


async def test_signing_in_again_ends_the_session_before(served: Served) -> None:
    service, people = served
    async with httpx.AsyncClient(base_url=service.url) as client:
        first = await sign_in(client, people.tokens[Role.HELPER])
        second = await sign_in(client, people.tokens[Role.HELPER])
    assert first != second
    assert await with_cookie(service, first) == 401
    assert await with_cookie(service, second) == 200


@pytest.mark.parametrize("how", ["revoke", "rotate"])
async def test_sessions_end_with_the_credential_that_began_them(served: Served, how: str) -> None:
    service, people = served
    async with httpx.AsyncClient(base_url=service.url) as client:
        cookie = await sign_in(client, people.tokens[Role.HELPER])
    assert await with_cookie(service, cookie) == 200
    getattr(people.editor, how)(NAMES[Role.HELPER], datetime.now(UTC))
    assert await with_cookie(service, cookie) == 401


async def test_a_session_says_whose_it_is(served: Served) -> None:
    service, people = served
    async with httpx.AsyncClient(base_url=service.url) as client:
        await sign_in(client, people.tokens[Role.HELPER])
        view = (await client.get("/api/session")).json()
    assert view == {"required": True, "signed_in": True, "name": "henri", "role": "helper"}


async def test_a_robot_cannot_sign_in(served: Served) -> None:
    service, people = served
    async with httpx.AsyncClient(base_url=service.url) as client:
        answer = await client.post("/api/session", json={"token": people.tokens[Role.ROBOT]})
    assert answer.status_code == 403
    assert "credential of a robot" in answer.json()["detail"]


# --- Connections ----------------------------------------------------------------------------------


async def test_the_open_socket_of_somebody_revoked_is_closed(served: Served) -> None:
    service, people = served
    async with connect(service.ws, additional_headers=people.headers(Role.HELPER)) as socket:
        assert (await message(socket))["type"] == "snapshot"
        people.revoke(Role.HELPER)
        async with as_a(served, Role.VIEWER) as other:
            assert (await other.get("/api/runs")).status_code == 200
        assert await close_code(socket) == 1008


async def test_nothing_goes_on_for_somebody_revoked(served: Served) -> None:
    service, people = served
    run = await start(served)
    shown = service.poses.open(run_state(run))
    shown.robot_connected(hello())
    headers = people.headers(Role.HELPER)
    live = service.ws.replace("helper", f"live?run={run}")
    async with (
        connect(service.ws, additional_headers=headers) as events,
        connect(live, additional_headers=headers) as watching,
    ):
        await message(events)
        await message(watching)
        assert {"HelperSocket._send_events", "LiveSocket._show"} <= connection_works()
        people.revoke(Role.HELPER)
        await service.access.look()
        assert await close_code(events) == await close_code(watching) == 1008
        await until(lambda: not connection_works())
    assert len(service.journal.subscribers) == 0
    assert not service.journal.trouble._watchers
    assert not shown._watchers


def connection_works() -> set[str]:
    """What connections of helpers have going on, each in a task."""
    names = {task.get_coro().__qualname__ for task in asyncio.all_tasks()}  # type: ignore[union-attr]
    return {each for each in names if each.startswith(("Helper", "LiveSocket"))}


async def test_the_open_socket_of_a_session_is_closed_when_that_is_signed_out(
    served: Served,
) -> None:
    service, people = served
    async with httpx.AsyncClient(base_url=service.url) as client:
        cookie = await sign_in(client, people.tokens[Role.HELPER])
        headers = {"Cookie": f"mend_session={cookie}"}
        async with connect(service.ws, additional_headers=headers) as socket:
            await message(socket)
            await client.delete("/api/session")
            assert await close_code(socket) == 1008


async def test_a_message_after_a_change_of_the_file_finds_the_new_role(served: Served) -> None:
    service, people = served
    async with connect(service.ws, additional_headers=people.headers(Role.HELPER)) as socket:
        await message(socket)
        text = people.file.read_text()
        people.file.write_text(text.replace("role: helper\n  id", "role: viewer\n  id"))
        dialogue = "2dc8e3f6-6479-4c12-9baf-d2534d0b7e34"
        await socket.send(json.dumps({"type": "claim", "id": 1, "dialogue": dialogue}))
        refusal = await message(socket)
    assert (refusal["id"], refusal["status"]) == (1, 403)
    assert "this needs the role 'helper'; you are a viewer" in refusal["detail"]


# --- Who did it -----------------------------------------------------------------------------------


async def test_a_helper_is_called_by_the_name_of_the_token(served: Served) -> None:
    service, people = served
    run = await start(served)
    view = await service.runs.raise_issue(run)
    assert view.prompt is not None
    address = f"{service.ws}?helper=somebody_else"
    async with connect(address, additional_headers=people.headers(Role.HELPER)) as socket:
        await message(socket)
        claim = {"type": "claim", "dialogue": str(view.dialogue)}
        await socket.send(json.dumps(claim))
    async with as_a(served, Role.HELPER) as client:
        answer = await client.post(
            f"/api/dialogues/{view.dialogue}/answers",
            json={"prompt": str(view.prompt.prompt), "answer": "yes", "helper": "anna"},
        )
    assert answer.status_code == 201
    assert answer.json()["helper"] == "henri"
    assert answer.json()["author"] == {
        "principal": "henri", "role": "helper", "address": "127.0.0.1",
    }  # fmt: skip
    (claimed,) = await of_type(service, ev.Claimed)
    assert (claimed.helper, claimed.author.principal) == ("henri", "henri")


async def test_with_the_services_token_helpers_say_their_names(tmp_path: Path) -> None:
    async with serving_people(tmp_path, token=TOKEN) as (service, _):
        headers = {"Authorization": f"Bearer {TOKEN}"}
        async with httpx.AsyncClient(base_url=service.url, headers=headers) as client:
            run = UUID((await client.post("/api/runs", json=RUN)).json()["id"])
            view = await service.runs.raise_issue(run)
            address = f"/api/dialogues/{view.dialogue}/claim"
            assert (await client.post(address, json={})).status_code == 422
            assert (await client.post(address, json={"helper": "anna"})).status_code == 200
        (claimed,) = await of_type(service, ev.Claimed)
        assert claimed.helper == "anna"
        assert (claimed.author.principal, claimed.author.role) == ("token", "admin")
        async with connect(service.ws, additional_headers=headers) as socket:
            assert (await message(socket))["errors"] == [
                "helper: is missing: with this token everybody says who it is"
            ]


async def test_what_an_operator_does_names_them(served: Served) -> None:
    service, _ = served
    run = await start(served)
    async with as_a(served, Role.OPERATOR) as client:
        for what in ("pause", "resume"):
            assert (await client.post(f"/api/runs/{run}/{what}")).status_code == 200
        steal = {"act": "steal", "object": "pink_bar"}
        answer = await client.post(f"/api/runs/{run}/interventions", json=steal)
        assert answer.status_code == 201
        assert (await client.post(f"/api/runs/{run}/abort")).status_code == 200
        tree = {"name": "mine", "text": "then: []"}
        assert (await client.post("/api/trees", json=tree)).status_code == 201
        assert (await client.put("/api/trees/mine", json=tree)).status_code == 200
        assert (await client.delete("/api/trees/mine")).status_code == 204
        assert (await client.delete("/api/trees/mine")).status_code == 404
    olga = ev.Author(principal="olga", role=Role.OPERATOR, address="127.0.0.1")
    events = await service.journal.read(0, 100)
    done = [each for each in events if getattr(each, "author", None) == olga]
    assert [each.type for each in done] == [  # type: ignore[attr-defined]
        "run_started", "run_paused", "run_resumed", "intervention_accepted", "run_aborted",
        "document_kept", "document_kept", "document_deleted",
    ]  # fmt: skip


async def test_what_is_done_to_access_is_in_the_journal_when_it_is_answered(
    served: Served,
) -> None:
    service, people = served
    nina = {"name": "nina", "role": "helper"}
    async with as_a(served, Role.ADMIN) as admin:
        assert (await admin.post("/api/access/principals", json=nina)).status_code == 201
        (added,) = await of_type(service, ev.AccessChanged)
        assert (added.what, added.principal) == ("added", "nina")
        failing(service.journal).error = "disk I/O error"
        refused = await admin.delete("/api/access/principals/nina")
        assert refused.status_code == 503
        assert "it is done, but the journal has yet to be told" in refused.json()["detail"]
        # From now on it is known that nothing can be journaled.
        otto = {"name": "otto", "role": "viewer"}
        assert (await admin.post("/api/access/principals", json=otto)).status_code == 503
    names = [each.name for each in read_principals(people.file).principals]
    assert not {"nina", "otto"} & set(names)


async def test_a_session_that_cannot_be_ended_lasts(served: Served) -> None:
    service, people = served
    async with httpx.AsyncClient(base_url=service.url) as client:
        cookie = await sign_in(client, people.tokens[Role.HELPER])
        connection = failing(service.journal)
        connection.error = "disk I/O error"
        refused = await client.delete("/api/session")
        assert refused.status_code == 503
        assert "the session lasts" in refused.json()["detail"]
        assert await with_cookie(service, cookie) == 200
        connection.error = None
        assert (await client.delete("/api/session")).status_code == 204
        (ended,) = await of_type(service, ev.SignedOut)
        assert ended.author.principal == "henri"
    assert await with_cookie(service, cookie) == 401


async def test_the_audit_is_for_admins_and_tells_who_did_what_from_where(served: Served) -> None:
    service, people = served
    run = await start(served)
    async with httpx.AsyncClient(base_url=service.url) as client:
        await sign_in(client, people.tokens[Role.HELPER])
        wrong = {"Authorization": "Bearer wrong"}
        assert (await client.get("/api/runs", headers=wrong)).status_code == 401
        assert (await client.delete("/api/session")).status_code == 204
    async with as_a(served, Role.ADMIN) as admin:
        page = (await admin.get("/api/access/deeds")).json()
        of_olga = (await admin.get("/api/access/deeds", params={"who": "olga"})).json()
        first = (await admin.get("/api/access/deeds", params={"limit": 1})).json()
        after = {"after": first["seq"]}
        rest = (await admin.get("/api/access/deeds", params=after)).json()
    told = [(each["deed"], each["who"], each["address"]) for each in page["deeds"]]
    assert sorted(told, key=str) == sorted(
        [
            ("run_started", "olga", "127.0.0.1"),
            ("signed_in", "henri", "127.0.0.1"),
            ("sign_in_failed", None, "127.0.0.1"),
            ("signed_out", "henri", "127.0.0.1"),
        ],
        key=str,
    )
    assert [each["run"] for each in of_olga["deeds"]] == [str(run)]
    assert first["more"]
    assert not rest["more"]
    assert first["deeds"] + rest["deeds"] == page["deeds"]


async def test_helpers_hear_nothing_of_what_belongs_to_no_run(served: Served) -> None:
    service, people = served
    async with connect(service.ws, additional_headers=people.headers(Role.ADMIN)) as socket:
        await message(socket)
        async with as_a(served, Role.OPERATOR) as client:
            tree = {"name": "mine", "text": "then: []"}
            assert (await client.post("/api/trees", json=tree)).status_code == 201
        await start(served)
        assert (await message(socket))["type"] == "run_started"


async def test_the_events_of_no_run_are_not_those_of_a_run(served: Served) -> None:
    async with as_a(served, Role.OPERATOR) as client:
        tree = {"name": "mine", "text": "then: []"}
        assert (await client.post("/api/trees", json=tree)).status_code == 201
        assert (await client.get(f"/api/runs/{ev.NO_RUN}/events")).status_code == 404


async def test_nobody_need_ask_anything_for_somebody_revoked_to_be_let_go(tmp_path: Path) -> None:
    people = People(tmp_path)
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none")
    async with open_service(settings) as service:
        address = service.url.replace("http", "ws", 1) + "/ws/helper"
        async with connect(address, additional_headers=people.headers(Role.HELPER)) as socket:
            assert (await message(socket))["type"] == "snapshot"
            people.revoke(Role.HELPER)
            assert await close_code(socket) == 1008


async def test_an_open_socket_ends_with_its_session() -> None:
    clock = [1_000_000.0]
    async with serving(token=TOKEN, wall_time_s=lambda: clock[0]) as service:
        async with httpx.AsyncClient(base_url=service.url) as client:
            headers = {"Cookie": f"mend_session={await sign_in(client, TOKEN)}"}
        async with connect(f"{service.ws}?helper=anna", additional_headers=headers) as socket:
            await message(socket)
            clock[0] += SESSION_LIFETIME_S
            service.access.let_go()
            assert await close_code(socket) == 1008


# --- Admins ---------------------------------------------------------------------------------------


async def test_an_admin_adds_rotates_and_revokes_over_rest(served: Served) -> None:
    service, _ = served
    async with as_a(served, Role.ADMIN) as admin:
        body = {"name": "nina", "role": "helper", "expires_days": 1}
        token = (await admin.post("/api/access/principals", json=body)).json()["token"]
        again = await admin.post("/api/access/principals", json=body)
        assert again.status_code == 409
        assert await status(service, token) == 200
        listed = (await admin.get("/api/access/principals")).json()
        assert [each["name"] for each in listed][-1] == "nina"
        assert token not in json.dumps(listed)
        rotated = await admin.post("/api/access/principals/nina/rotate", json={})
        assert await status(service, token) == 401
        assert await status(service, rotated.json()["token"]) == 200
        assert (await admin.delete("/api/access/principals/nina")).status_code == 204
        assert await status(service, rotated.json()["token"]) == 401
        assert (await admin.delete("/api/access/principals/nina")).status_code == 404
        reserved = {"name": "token", "role": "admin"}
        answer = await admin.post("/api/access/principals", json=reserved)
        assert answer.status_code == 422
    changes = await of_type(service, ev.AccessChanged)
    assert [(each.what, each.principal, each.author.principal) for each in changes] == [
        (what, "nina", "ada") for what in ("added", "rotated", "revoked")
    ]


async def test_the_client_manages_access_and_reads_deeds(served: Served) -> None:
    service, people = served
    async with MendClient(service.url, token=people.tokens[Role.ADMIN]) as admin:
        given = await admin.add_principal("nina & co", "viewer", expires_days=2)
        assert await status(service, given.token) == 200
        rotated = await admin.rotate_principal("nina & co")
        assert await status(service, given.token) == 401
        assert [each.name for each in await admin.principals()][-1] == "nina & co"
        await admin.revoke_principal("nina & co")
        assert await status(service, rotated.token) == 401
        assert (await admin.open_enrolment("arm-7", minutes=1)).robot == "arm-7"
        deeds = (await admin.deeds(who="ada")).deeds
    assert [each.what for each in deeds] == [
        "added 'nina & co' as a viewer",
        "gave 'nina & co' a new token",
        "revoked 'nina & co'",
        "made a code for the robot 'arm-7'",
    ]


async def test_the_audit_of_a_journal_that_is_in_use_is_read_from_its_file(tmp_path: Path) -> None:
    People(tmp_path)
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(60):
        with service.journal.subscribe(0) as subscription:
            async for record in subscription:
                if record.seq == len(NAMES):
                    break
        deeds = audit_of(settings.journal_path).deeds
    assert [(each.who, each.what) for each in deeds] == [
        ("root", f"added '{name}' as {'an' if name in ('olga', 'ada') else 'a'} {role}")
        for role, name in NAMES.items()
    ]


# --- What they share ------------------------------------------------------------------------------


async def start(served: Served) -> UUID:
    async with as_a(served, Role.OPERATOR) as client:
        answer = await client.post("/api/runs", json=RUN)
    assert answer.status_code == 201
    return UUID(answer.json()["id"])


async def status(service: ServiceUnderTest, token: str) -> int:
    headers = {"Authorization": f"Bearer {token}"}
    async with httpx.AsyncClient(base_url=service.url, headers=headers) as client:
        return (await client.get("/api/runs")).status_code


async def of_type(service: ServiceUnderTest, kind: type[ev.Event]) -> list[Any]:
    return [each for each in await service.journal.read(0, 1000) if isinstance(each, kind)]
