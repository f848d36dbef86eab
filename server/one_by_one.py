"""Work that is done one piece after the other, of which no more may wait than there is room for."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from weakref import WeakValueDictionary

from mend.server.asking import asker
from mend.server.errors import BusyError
from mend.server.limits import LimitName


class OneByOne:
    """Gives turns to those who ask, and to each of them in the order in which they do.

    Nobody waits for more than one turn of each other one, however many those want. All that is
    under way or waits has at most the size `most`, but everybody may have one turn there. `limit`
    is what that is called, and `what` waits then.
    """

    def __init__(
        self, most: int, what: str = "large files", limit: LimitName = "waiting_chars"
    ) -> None:
        self._most = most
        self._what = what
        self._limit = limit
        self._size = 0
        self._turn = asyncio.Lock()
        # One of each at a time stands in line for the turn; there while somebody wants them.
        self._places: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    @asynccontextmanager
    async def turn(self, size: int) -> AsyncIterator[None]:
        """A turn for a piece of work of a size, as `most` counts it. Raises `BusyError`."""
        place = self._places.setdefault(asker.get(), asyncio.Lock())
        if place.locked() and self._size + size > self._most:
            raise BusyError(
                f"too many {self._what} wait to be read and checked already; try it again later",
                limit=self._limit,
            )
        self._size += size
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
            self._size -= size
