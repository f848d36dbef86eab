"""Work that is done one piece after the other, of which no more may wait than there is room for."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from weakref import WeakValueDictionary

from mend.server.asking import asker
from mend.server.errors import BusyError


class OneByOne:
    """Gives turns to those who ask, and to each of them in the order in which they do.

    Nobody waits for more than one turn of each other one, however many those want. All that is
    under way or waits has at most `most_chars` characters, but everybody may have one turn there.
    """

    def __init__(self, most_chars: int) -> None:
        self._most_chars = most_chars
        self._chars = 0
        self._turn = asyncio.Lock()
        # One of each at a time stands in line for the turn; there while somebody wants them.
        self._places: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    @asynccontextmanager
    async def turn(self, chars: int) -> AsyncIterator[None]:
        """A turn for a piece of work with so many characters. Raises `BusyError`."""
        place = self._places.setdefault(asker.get(), asyncio.Lock())
        if place.locked() and self._chars + chars > self._most_chars:
            raise BusyError(
                "too many large files wait to be read and checked already; try it again later",
                limit="waiting_chars",
            )
        self._chars += chars
        try:
            async with place, self._turn:
                # What is asked for during the turn stands in no line behind what the same one
                # asked for before: all others wait for it.
                before = asker.set(f"{asker.get()} in turn {id(self)}")
                try:
                    yield
                finally:
                    asker.reset(before)
        finally:
            self._chars -= chars
