"""The service on its own certificate, with a real handshake."""

import asyncio
import contextlib
import socket
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest
from certificates import Certificate, make_certificate
from raw_client import raw_client
from websockets.asyncio.client import connect

from mend.robots.link.channel import ChannelClosedError
from mend.robots.link.pinned_tls import pinned_tls
from mend.robots.link.websocket import websocket_channel
from mend.server.composition import Service, open_service
from mend.server.limits import Limits
from mend.server.robots.address import ROBOT_PATH
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings, WrongSettingsError

TOKEN = "correct-horse-battery"
RIGHT = {"Authorization": f"Bearer {TOKEN}"}
LIMITS = Limits(head_s=0.3)


@dataclass(frozen=True)
class Encrypted:
    service: Service
    certificate: Certificate

    @property
    def url(self) -> str:
        return self.service.url

    @property
    def ws(self) -> str:
        return self.url.replace("https", "wss", 1)

    @property
    def port(self) -> int:
        return urlsplit(self.url).port or 0


@pytest.fixture
def certificate(tmp_path: Path) -> Certificate:
    return make_certificate(tmp_path / "tls", "127.0.0.1")


@contextlib.asynccontextmanager
async def encrypted(folder: Path, certificate: Certificate) -> AsyncIterator[Encrypted]:
    settings = Settings(
        port=0,
        data_dir=folder,
        token=TOKEN,
        speech_voice="none",
        limits=LIMITS,
        tls_certificate=certificate.path,
        tls_key=certificate.key,
    )
    async with open_service(settings) as service:
        yield Encrypted(service, certificate)


@pytest.fixture
async def over_tls(tmp_path: Path, certificate: Certificate) -> AsyncIterator[Encrypted]:
    async with encrypted(tmp_path, certificate) as over_tls:
        yield over_tls


async def test_rest_and_sessions_go_over_tls(over_tls: Encrypted) -> None:
    assert over_tls.url.startswith("https://127.0.0.1:")
    trusted = over_tls.certificate.client_context()
    async with httpx.AsyncClient(base_url=over_tls.url, verify=trusted) as client:
        response = await client.post("/api/session", json={"token": TOKEN})
        assert response.headers["strict-transport-security"] == "max-age=31536000"
        assert "secure" in response.headers["set-cookie"].lower()
        assert (await client.get("/api/runs")).status_code == 200


async def test_websockets_go_over_tls(over_tls: Encrypted) -> None:
    trusted = over_tls.certificate.client_context()
    origin = {"Origin": over_tls.url}
    async with connect(
        f"{over_tls.ws}/ws/helper?helper=anna", ssl=trusted, additional_headers=RIGHT | origin
    ) as helper:
        assert '"snapshot"' in str(await helper.recv())


async def test_who_does_not_know_the_issuer_does_not_connect(over_tls: Encrypted) -> None:
    async with httpx.AsyncClient(base_url=over_tls.url) as client:
        with pytest.raises(httpx.ConnectError, match="certificate verify failed"):
            await client.get("/healthz")


async def test_plain_http_is_not_spoken(over_tls: Encrypted) -> None:
    async with httpx.AsyncClient(base_url=over_tls.url.replace("https", "http", 1)) as client:
        with pytest.raises(httpx.TransportError):
            await client.get("/healthz")


async def test_a_handshake_that_does_not_come_ends_the_connection(over_tls: Encrypted) -> None:
    async with raw_client(over_tls.port) as silent, raw_client(over_tls.port) as half:
        half.send(b"\x16\x03\x01\x02\x00\x01")
        assert await silent.end() == b""
        assert await half.end() == b""


async def test_a_robot_of_this_machine_trusts_that_certificate_alone(
    over_tls: Encrypted, tmp_path: Path
) -> None:
    channel = await websocket_channel(
        over_tls.ws + ROBOT_PATH, TOKEN, pinned_tls(over_tls.certificate.path)
    )
    await channel.close()
    other = make_certificate(tmp_path / "other", "127.0.0.1")
    with pytest.raises(ChannelClosedError, match="certificate verify failed"):
        await websocket_channel(over_tls.ws + ROBOT_PATH, TOKEN, pinned_tls(other.path))


async def test_a_certificate_need_not_name_the_address_that_a_robot_of_this_machine_uses(
    tmp_path: Path,
) -> None:
    named = make_certificate(tmp_path / "named", "mend.example.com")
    async with encrypted(tmp_path, named) as over_tls:
        channel = await websocket_channel(over_tls.ws + ROBOT_PATH, TOKEN, pinned_tls(named.path))
        await channel.close()


async def test_a_wrong_certificate_ends_the_start_and_leaves_the_port(
    tmp_path: Path, certificate: Certificate
) -> None:
    other = make_certificate(tmp_path / "other", "127.0.0.1")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    settings = Settings(
        port=port, data_dir=tmp_path, tls_certificate=certificate.path, tls_key=other.key
    )
    with pytest.raises(WrongSettingsError, match="is not the key of the certificate"):
        async with open_service(settings):
            pass
    with socket.socket() as free:
        free.bind(("127.0.0.1", port))


@pytest.mark.slow
async def test_a_simulated_robot_in_a_process_of_its_own_works_over_tls(
    over_tls: Encrypted,
) -> None:
    pytest.importorskip("pybullet")
    request = RunRequest(tree="eket", world="workcell", speed="max", seed=7)
    run = await over_tls.service.runtime.start_run(request)
    async with asyncio.timeout(300):
        while not any(each.connected for each in over_tls.service.runtime.robots()):  # noqa: ASYNC110
            await asyncio.sleep(0.1)
    await over_tls.service.runtime.abort(run.id)
    await over_tls.service.runtime.wait_for_end(run.id)
