"""Work that is done one piece after the other, of which no more may wait than there is room for."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from server.errors import BusyError


class OneByOne:
    """Gives turns in the order in which they are asked for.

    All that is under way or waits has at most `most_chars` characters; one alone may have more.
    """

    def __init__(self, most_chars: int) -> None:
        self._most_chars = most_chars
        self._chars = 0
        self._turn = asyncio.Lock()

    @asynccontextmanager
    async def turn(self, chars: int) -> AsyncIterator[None]:
        """A turn for a piece of work with so many characters. Raises `BusyError`."""
        if self._chars > 0 and self._chars + chars > self._most_chars:
            raise BusyError(
                "too many large files wait to be read and checked already; try it again later",
                limit="waiting_chars",
            )
        self._chars += chars
        try:
            async with self._turn:
                yield
        finally:
            self._chars -= chars
