"""A mutated message on a WebSocket, and what is answered."""

import asyncio
import contextlib

from fuzz_mutations import Mutator
from websockets.asyncio.client import ClientConnection


async def said(socket: ClientConnection, mutator: Mutator, sample: bytes) -> list[str]:
    """Send a message and a ping after it; what is answered until the pong comes."""
    binary = mutator.random.random() < 0.1
    with contextlib.suppress(UnicodeDecodeError):
        await socket.send(sample if binary else sample.decode())
        await (await socket.ping())
    answers: list[str] = []
    with contextlib.suppress(TimeoutError):
        while True:
            async with asyncio.timeout(0.0005):
                answers.append(str(await socket.recv()))
    return answers
