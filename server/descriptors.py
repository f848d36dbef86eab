"""What to do while this process has no file descriptor left: wait, as others give theirs back."""

import asyncio
import errno
import os
from collections.abc import Awaitable, Callable
from typing import TypeVar

NO_DESCRIPTOR = (errno.EMFILE, errno.ENFILE)

TRY_AGAIN_S = 0.5

T = TypeVar("T")


async def once_there_are_descriptors(
    make: Callable[[], Awaitable[T]], sleep: Callable[[float], Awaitable[None]] = asyncio.sleep
) -> T:
    """Make something that needs descriptors, again and again for as long as there are none.

    Raises whatever else keeps it from being made.
    """
    while True:
        try:
            return await make()
        except OSError as error:
            if not is_for_want_of_descriptors(error):
                raise
        await sleep(TRY_AGAIN_S)


def is_for_want_of_descriptors(error: BaseException) -> bool:
    """Whether something failed only because this process had none left."""
    return isinstance(error, OSError) and error.errno in NO_DESCRIPTOR


async def until_there_are_descriptors(
    sleep: Callable[[float], Awaitable[None]] = asyncio.sleep,
) -> None:
    """Wait until this process can open something again."""
    os.close(await once_there_are_descriptors(_any_descriptor, sleep))


async def _any_descriptor() -> int:
    return os.open(os.devnull, os.O_RDONLY)
