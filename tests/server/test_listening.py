"""The service's socket: small messages leave at once, and a taken port is said so."""

import asyncio
import socket
from pathlib import Path

import pytest

from mend.server.listening import listen
from mend.server.settings import Settings


async def test_small_messages_are_not_held_back(tmp_path: Path) -> None:
    without_delay: list[int] = []

    async def accept(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        connection = writer.get_extra_info("socket")
        without_delay.append(connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
        writer.close()

    listening = listen(Settings(port=0, data_dir=tmp_path))
    port = listening.getsockname()[1]
    async with await asyncio.start_server(accept, sock=listening):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        await reader.read()
        writer.close()
    assert without_delay == [1]


def test_a_taken_port_is_named(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(OSError, match=f"cannot listen on 127.0.0.1:{port}"):
            listen(Settings(port=port, data_dir=tmp_path))
