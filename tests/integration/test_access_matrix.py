"""Who may do what: every endpoint and every message, for every role, and the page that says so."""

import json
import re
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any
from uuid import uuid4

import httpx
import pytest
import pytest_asyncio
from access_rows import SOCKETS as OFFERED
from access_rows import Request, requests
from people import People, serving_people
from service_under_test import ServiceUnderTest
from websockets.asyncio.client import connect

from mend.server.access import permissions
from mend.server.access.roles import PEOPLE, Role

DOCUMENT = Path(__file__).parents[2] / "docs" / "access.md"
ROLES = (*PEOPLE, Role.ROBOT)

Served = tuple[ServiceUnderTest, People]


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def served(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Served]:
    """One for all, which describes itself once: nobody asks for anything that there is."""
    async with serving_people(tmp_path_factory.mktemp("people")) as served:
        yield served


def test_every_endpoint_has_its_row_and_no_other_has() -> None:
    offered = {(each.operation, each.method, each.template) for each in requests()}
    rows = {
        (each.operation, each.method, re.sub(r":path}", "}", each.path))
        for each in permissions.ENDPOINTS
    }
    assert rows == offered
    assert len(permissions.ENDPOINTS) == len(offered)


def test_every_message_of_every_socket_has_its_row_and_no_other_has() -> None:
    assert {path: set(rows) for path, rows in permissions.MESSAGES.items()} == OFFERED
    assert permissions.SOCKETS.keys() == OFFERED.keys()


def test_what_has_no_row_needs_an_admin() -> None:
    assert permissions.needed_for_request("GET", "/api/nowhere") is Role.ADMIN
    assert permissions.needed_for_message("/ws/helper", "nothing") is Role.ADMIN


ROLE_OF = {each.operation: each.role for each in permissions.ENDPOINTS}


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize("role", [*ROLES, None], ids=str)
async def test_requests_are_refused_by_role_and_by_nothing_else(
    served: Served, role: Role | None
) -> None:
    service, people = served
    headers = {} if role is None else people.headers(role)
    wrong = []
    async with httpx.AsyncClient(base_url=service.url, headers=headers) as client:
        for each in requests():
            answer = await _ask(client, each)
            expected = _expected(ROLE_OF[each.operation], role)
            if (answer.status_code if answer.status_code in (401, 403) else None) != expected:
                wrong.append((each.operation, answer.status_code, expected))
            if expected == 403:
                needed = ROLE_OF[each.operation]
                assert answer.headers["content-type"] == "application/problem+json"
                assert f"needs the role '{needed}'" in answer.json()["detail"]
    assert wrong == []


def _expected(needed: Role | None, role: Role | None) -> int | None:
    if needed is None:
        return None
    if role is None:
        return 401
    return None if role.may(needed) else 403


async def _ask(client: httpx.AsyncClient, request: Request) -> httpx.Response:
    # What an open door asks for besides a role is not what is tried here.
    body = b"" if request.operation in ("sign_in", "enrol_robot") else b"{}"
    content: dict[str, Any] = {} if request.method == "GET" else {"content": body}
    if request.method != "GET":
        content["headers"] = {"Content-Type": "application/json"}
    return await client.request(request.method, request.path, **content)


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize("role", ROLES, ids=str)
@pytest.mark.parametrize("path", ["/ws/helper", "/ws/live", "/ws/speech"])
async def test_sockets_and_their_messages_are_refused_by_role(
    served: Served, path: str, role: Role
) -> None:
    service, people = served
    address = f"{service.ws.replace('/ws/helper', path)}?run={uuid4()}"
    async with connect(address, additional_headers=people.headers(role)) as socket:
        if not role.may(permissions.SOCKETS[path]):
            refusal = json.loads(await socket.recv())
            assert refusal["status"] == 403
            assert f"needs the role '{permissions.SOCKETS[path]}'" in refusal["detail"]
            return
        if path == "/ws/live":
            # There is nothing to say on it; that there is no such run is found out inside.
            assert json.loads(await socket.recv())["status"] == 404
            return
        if path == "/ws/helper":
            assert json.loads(await socket.recv())["type"] == "snapshot"
        for kind, needed in permissions.MESSAGES[path].items():
            if needed is not None:
                assert await _is_refused(socket, kind) == (not role.may(needed)), kind


async def _is_refused(socket: Any, kind: str) -> bool:
    message = {"type": kind, "id": kind, **FIELDS.get(kind, {})}
    await socket.send(json.dumps(message))
    if kind == "cancel":
        # Nothing comes of it where it may be done: what is asked after it is answered instead.
        await socket.send(json.dumps({"type": "spoken", "id": "after"}))
    answer = json.loads(await socket.recv())
    if answer.get("status") != 403:
        return False
    assert "needs the role 'helper'" in answer["detail"]
    assert answer["id"] == kind
    return True


IDS = {"dialogue": str(uuid4()), "prompt": str(uuid4())}
FIELDS: dict[str, dict[str, Any]] = {
    "answer": {**IDS, "answer": "yes"},
    "choose": {**IDS, "way": "place"},
    "claim": {"dialogue": IDS["dialogue"]},
    "release": {"dialogue": IDS["dialogue"]},
    "extend": IDS,
    "done": {"dialogue": IDS["dialogue"]},
    "take_back": {"dialogue": IDS["dialogue"]},
    "listen": IDS,
}


def test_the_page_says_what_the_table_says() -> None:
    documented = re.findall(
        r"^\| `([^`]+)` \| (?:`([A-Z]+) ([^`]+)`|`(/ws/\w+)`) \| ([\w ]+) \|$",
        DOCUMENT.read_text(),
        flags=re.MULTILINE,
    )
    requests_said = {(row[0], row[1], row[2], row[4]) for row in documented if row[1]}
    assert requests_said == {
        (each.operation, each.method, each.path, str(each.role or "anybody"))
        for each in permissions.ENDPOINTS
    }
    messages_said = {(row[3], row[0], row[4]) for row in documented if row[3]}
    assert messages_said == {
        (path, kind, str(role or "anybody"))
        for path, rows in permissions.MESSAGES.items()
        for kind, role in {"open": permissions.SOCKETS[path], **rows}.items()
    }
