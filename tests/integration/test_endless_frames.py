"""Who sends parts of messages, or pings, without end is sent away."""

from contextlib import suppress
from urllib.parse import urlsplit

import pytest
from raw_client import raw_client
from service_under_test import ServiceUnderTest, serving
from websockets.frames import Close, Frame, Opcode

from mend.server.websocket_protocol import MOST_FRAGMENTS, PINGS_AT_ONCE

FIRST_PART = Frame(Opcode.TEXT, b"{", fin=False).serialize(mask=True)
EMPTY_PART = Frame(Opcode.CONT, b"", fin=False).serialize(mask=True)
LAST_PART = Frame(Opcode.CONT, b"}", fin=True).serialize(mask=True)
PING = Frame(Opcode.PING, b"").serialize(mask=True)


@pytest.fixture
async def service() -> ServiceUnderTest:
    async with serving() as service:
        yield service


async def last_words(service: ServiceUnderTest, sent: bytes) -> bytes:
    """All that is said to a helper who sends this."""
    async with raw_client(urlsplit(service.url).port or 0) as client:
        await client.upgraded("/ws/helper?helper=anna")
        client.send(sent)
        with suppress(ConnectionError):
            await client.drained()
        return await client.end()


def farewell(code: int, reason: str) -> bytes:
    return Frame(Opcode.CLOSE, Close(code, reason).serialize()).serialize(mask=False)


async def test_a_message_in_parts_without_end_ends_the_connection(
    service: ServiceUnderTest,
) -> None:
    said = await last_words(service, FIRST_PART + EMPTY_PART * 10 * MOST_FRAGMENTS)
    assert farewell(1009, f"a message comes in at most {MOST_FRAGMENTS} parts") in said
    assert service.refusals.counts["message_parts"] == 1


async def test_pings_without_end_end_the_connection(service: ServiceUnderTest) -> None:
    said = await last_words(service, PING * 20 * PINGS_AT_ONCE)
    assert farewell(1008, "at most 10 pings a second") in said
    assert service.refusals.counts["pings"] == 1


async def test_a_message_in_some_parts_and_some_pings_are_taken(
    service: ServiceUnderTest,
) -> None:
    async with raw_client(urlsplit(service.url).port or 0) as client:
        await client.upgraded("/ws/helper?helper=anna")
        parts = FIRST_PART + EMPTY_PART * (MOST_FRAGMENTS - 2) + LAST_PART
        client.send((parts + PING * 10) * 3)
        said = b""
        while said.count(b'"type":"error"') < 3:
            said += await client.reader.read(1 << 16)
