"""A mutated message on a WebSocket, and what is answered to it rather than to what comes after."""

import asyncio
import json
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from fuzz_bench import PATIENCE_S
from fuzz_mutations import Mutator
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed


async def said(
    socket: ClientConnection,
    messages: Sequence[bytes | str],
    answers_the_last: Callable[[dict[str, Any]], bool],
) -> list[str]:
    """Send messages, the last one with a known answer; all that is answered before that comes.

    What is answered late, as it waits for the disk, is so told of the message that it is for. An
    end of the connection is an answer too. Raises `TimeoutError` if none comes.
    """
    with suppress(ConnectionClosed):
        for each in messages:
            await socket.send(each)
    answers: list[str] = []
    with suppress(ConnectionClosed):
        async with asyncio.timeout(PATIENCE_S):
            while not answers_the_last(json.loads(text := str(await socket.recv()))):
                answers.append(text)
    return answers


def framed(mutator: Mutator, sample: bytes) -> bytes | str:
    """As a text frame; now and then, and where it is no text, as a binary one."""
    if mutator.random.random() < 0.1:
        return sample
    try:
        return sample.decode()
    except UnicodeDecodeError:
        return sample
