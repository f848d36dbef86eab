"""What to do while this process has no file descriptor left: wait, as others give theirs back."""

import asyncio
import errno
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
            if error.errno not in NO_DESCRIPTOR:
                raise
        await sleep(TRY_AGAIN_S)
