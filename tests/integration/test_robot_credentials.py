"""Robots enrol with a one-time code, and nobody takes over the name of another robot."""

import asyncio
import time
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest
from example_robot import example_robot
from people import NAMES, People
from raw_client import raw_client, text_frame
from recording_sink import RecordingSink
from service_under_test import TOKEN, ServiceUnderTest, serving, until
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from mend.robots.link.channel import ChannelClosedError, LinkRefusedError
from mend.robots.link.enrolment import robot_credential
from mend.robots.link.messages import Hello, LinkError, Welcome, service_message
from mend.robots.link.websocket import websocket_channel
from mend.server.access.access import Access
from mend.server.access.roles import PEOPLE, Role
from mend.server.api.robot_socket import add_robot_route
from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.limits import Limits
from mend.server.robots.address import ROBOT_PATH
from mend.server.robots.passes import OwnRobots
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.times import LinkTimes
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings


@dataclass
class Robots:
    """A service with a door for robots."""

    service: ServiceUnderTest
    registry: RobotRegistry
    people: People

    @property
    def url(self) -> str:
        return self.service.url.replace("http", "ws", 1) + ROBOT_PATH


@pytest.fixture
async def robots(tmp_path: Path) -> AsyncIterator[Robots]:
    people = People(tmp_path)
    async with serving(principals=people.file, token=TOKEN) as service:
        registry = RobotRegistry(service.journal, time.monotonic)
        add_robot_route(service.app, registry, service.access)
        yield Robots(service, registry, people)
        registry.close()


def hello(robot: str) -> str:
    reach = {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 1.0}
    fields = {"protocol": 1, "robot": robot, "boot": "b", "behaviors": [], "cameras": []}
    return Hello.model_validate({**fields, "reach": reach, "time": 0.0}).model_dump_json()


async def said_to(url: str, robot: str, token: str | None) -> Welcome | LinkError:
    """What the service answers to a hello."""
    headers = {} if token is None else {"Authorization": f"Bearer {token}"}
    async with connect(url, additional_headers=headers) as socket:
        await socket.send(hello(robot))
        answer = service_message.validate_json(await socket.recv())
    assert isinstance(answer, Welcome | LinkError)
    return answer


async def at_once(_: float) -> None:
    """The clock stands still: who has to wait goes on at once."""


async def test_a_robot_that_connects_without_end_has_to_come_again(tmp_path: Path) -> None:
    people = People(tmp_path)
    limits = Limits(requests_per_s=1)
    async with serving(
        principals=people.file, now=lambda: 0.0, sleep=at_once, limits=limits
    ) as service:
        registry = RobotRegistry(service.journal, time.monotonic)
        add_robot_route(service.app, registry, service.access)
        url, token = service.url.replace("http", "ws", 1) + ROBOT_PATH, people.tokens[Role.ROBOT]
        # Four seconds' worth at once, and as many that wait.
        for _ in range(8):
            await (await websocket_channel(url, token)).close()
        with pytest.raises(ChannelClosedError, match="faster than 'requests_per_s' allows"):
            await websocket_channel(url, token)
        registry.close()


async def test_a_robot_comes_in_with_its_own_credential(robots: Robots) -> None:
    token = robots.people.tokens[Role.ROBOT]
    assert isinstance(await said_to(robots.url, NAMES[Role.ROBOT], token), Welcome)


async def test_a_credential_is_good_for_one_name_alone(robots: Robots) -> None:
    answer = await said_to(robots.url, "arm-2", robots.people.tokens[Role.ROBOT])
    assert isinstance(answer, LinkError)
    assert "this credential is that of the robot 'arm-1'" in answer.detail
    assert robots.registry.hello("arm-2") is None


async def test_nobody_takes_the_name_of_an_enrolled_robot(robots: Robots) -> None:
    answer = await said_to(robots.url, "arm-1", TOKEN)
    assert isinstance(answer, LinkError)
    assert "the robot 'arm-1' has a credential of its own" in answer.detail
    assert isinstance(await said_to(robots.url, "free", TOKEN), Welcome)


@pytest.mark.parametrize("role", PEOPLE, ids=str)
async def test_the_token_of_a_person_is_none_of_a_robot(robots: Robots, role: Role) -> None:
    with pytest.raises(InvalidStatus) as refused:
        await said_to(robots.url, "arm-3", robots.people.tokens[role])
    assert refused.value.response.status_code == 401


async def test_a_connected_robot_is_let_go_when_it_is_revoked(robots: Robots) -> None:
    headers = robots.people.headers(Role.ROBOT)
    async with connect(robots.url, additional_headers=headers) as socket:
        await socket.send(hello("arm-1"))
        assert isinstance(service_message.validate_json(await socket.recv()), Welcome)
        robots.people.revoke(Role.ROBOT)
        await robots.service.access.look()
        last = service_message.validate_json(await socket.recv())
        assert isinstance(last, LinkError)
        assert "good no longer" in last.detail
        await socket.wait_closed()
    with pytest.raises(InvalidStatus):
        await said_to(robots.url, "arm-1", robots.people.tokens[Role.ROBOT])


async def test_nothing_more_is_heard_of_a_revoked_robot_that_does_not_read(tmp_path: Path) -> None:
    people = People(tmp_path)
    patient = Limits(stuck_client_s=3600.0, robot_messages_per_s=1_000_000)
    async with (
        serving(principals=people.file, limits=patient) as service,
        raw_client(urlsplit(service.url).port or 0) as client,
    ):
        times = LinkTimes(silence_s=3600.0)
        registry = RobotRegistry(service.journal, time.monotonic, times, patient)
        add_robot_route(service.app, registry, service.access)
        headers = people.headers(Role.ROBOT).items()
        await client.upgraded(ROBOT_PATH, *(f"{key}: {value}" for key, value in headers))
        client.send(text_frame(hello("arm-1")))
        await until(lambda: registry.connected("arm-1"))
        session = registry._robots["arm-1"].session
        assert session is not None
        outgoing = session._outgoing

        def no_more_can_be_sent_to_it() -> bool:
            # Each is answered with what is wrong with it.
            client.send(text_frame("{}") * 50)
            return outgoing.qsize() > 100

        await until(no_more_can_be_sent_to_it)
        people.revoke(Role.ROBOT)
        await service.access.look()
        await until(lambda: not registry.connected("arm-1"))
        registry.close()


async def test_a_code_is_exchanged_once_for_a_credential_that_is_kept(
    robots: Robots, tmp_path: Path
) -> None:
    code = robots.people.editor.open_enrolment("arm-9", datetime.now(UTC), minutes=15)
    file = tmp_path / "credential"

    def fetch(name: str, into: Path, with_code: str | None) -> str:
        return robot_credential(robots.url, name, into, with_code)

    with pytest.raises(LinkRefusedError, match="has no credential in"):
        fetch("arm-9", file, None)
    with pytest.raises(LinkRefusedError, match="does not enrol the robot 'arm-8'"):
        await asyncio.to_thread(fetch, "arm-8", file, code)
    assert not file.exists()
    token = await asyncio.to_thread(fetch, "arm-9", file, code)
    assert file.stat().st_mode & 0o777 == 0o600
    assert fetch("arm-9", file, None) == token
    assert isinstance(await said_to(robots.url, "arm-9", token), Welcome)
    with pytest.raises(LinkRefusedError, match="does not enrol"):
        await asyncio.to_thread(fetch, "arm-9", tmp_path / "other", code)
    await robots.service.deeds.written()
    events = await robots.service.journal.read(0, 100, ev.NO_RUN)
    (enrolled,) = [each for each in events if isinstance(each, ev.AccessChanged)]
    assert (enrolled.what, enrolled.principal) == ("enrolled", "arm-9")
    assert enrolled.author.address == "127.0.0.1"
    assert any(isinstance(each, ev.SignInFailed) for each in events)


async def test_an_admin_makes_a_code_over_rest(robots: Robots) -> None:
    url, headers = robots.service.url, robots.people.headers(Role.ADMIN)
    async with httpx.AsyncClient(base_url=url, headers=headers) as admin:
        body = {"robot": "arm-5"}
        code = (await admin.post("/api/access/enrolments", json=body)).json()["code"]
    async with httpx.AsyncClient(base_url=url) as stranger:
        body = {"robot": "arm-5", "code": code}
        given = (await stranger.post("/api/robots/enrol", json=body)).json()
    assert isinstance(await said_to(robots.url, "arm-5", given["token"]), Welcome)


@pytest.mark.slow
async def test_the_example_robot_enrols_and_comes_back(robots: Robots, tmp_path: Path) -> None:
    code = robots.people.editor.open_enrolment("demo", datetime.now(UTC), minutes=15)
    sink = RecordingSink(robots.service.journal)
    robots.registry.assign("demo", sink)
    file = ("--credential", str(tmp_path / "credential"))
    async with example_robot(robots.url, *file, "--code", code):
        await sink.wait_until(lambda: len(sink.hellos) == 1)
    async with example_robot(robots.url, *file):
        await sink.wait_until(lambda: len(sink.hellos) == 2)


@pytest.mark.parametrize("token", [None, TOKEN], ids=str)
async def test_the_name_of_a_robot_that_the_service_runs_is_nobody_elses(token: str | None) -> None:
    own = OwnRobots()
    access = Access(token, own_robots=own, wall_time_s=time.time)
    credential = own.issue("pr2-1")
    async with serving() as service:
        registry = RobotRegistry(service.journal, time.monotonic)
        add_robot_route(service.app, registry, access)
        url = service.url.replace("http", "ws", 1) + ROBOT_PATH
        answer = await said_to(url, "pr2-1", token)
        assert isinstance(answer, LinkError)
        assert isinstance(await said_to(url, "pr2-1", credential), Welcome)
        answer = await said_to(url, "pr2-2", credential)
        assert isinstance(answer, LinkError)
        # Also between the end of its process and the start of the next one.
        own.withdraw(credential)
        assert own.of_token(credential) is None
        assert isinstance(await said_to(url, "pr2-1", token), LinkError)
        assert isinstance(await said_to(url, "pr2-1", own.issue("pr2-1")), Welcome)
        registry.close()


@pytest.mark.slow
@pytest.mark.parametrize("token", [None, TOKEN], ids=str)
async def test_a_stranger_is_not_the_simulated_robot_of_a_run(
    tmp_path: Path, token: str | None
) -> None:
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none", token=token)
    async with open_service(settings) as service:
        request = RunRequest(tree="eket", world="tabletop", speed=0.01)
        run = await service.runtime.start_run(request)
        url = service.url.replace("http", "ws", 1) + ROBOT_PATH
        answer = await said_to(url, run.robots[0], token)
        assert isinstance(answer, LinkError)
        assert "has a credential of its own" in answer.detail
        assert not (await service.runtime.run(run.id)).status.ended
        await service.runtime.abort(run.id)
