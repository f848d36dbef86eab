"""How fast a client is listened to: one that floods waits, and nobody else does."""

import asyncio
import math
from collections.abc import Awaitable, Callable
from functools import partial

CHARS_OF_ONE = 4096
"""A longer message counts as one for each such part."""

BURST_S = 4.0
"""What was not said for so long may come at once."""

Sleep = Callable[[float], Awaitable[None]]


def _nothing() -> None:
    return None


class Pace:
    """Lets through `per_s` messages a second; `now` is any monotonic clock in seconds.

    `held_back` is called for each that had to wait.
    """

    def __init__(
        self,
        per_s: float,
        now: Callable[[], float],
        held_back: Callable[[], None] = _nothing,
        sleep: Sleep = asyncio.sleep,
    ) -> None:
        self._per_s = per_s
        self._now = now
        self._held_back = held_back
        self._sleep = sleep
        self._left = per_s * BURST_S
        self._at = now()

    async def keep(self, chars: int = 0, patience_s: float = math.inf) -> float:
        """Take one in, and wait for as long as no more are to be read; returns for how long.

        One that would have to wait longer than `patience_s` is to be refused, and does not wait.
        """
        wait_s = self.take(chars, patience_s)
        if wait_s > 0.0:
            self._held_back()
            if wait_s <= patience_s:
                await self._sleep(wait_s)
        return wait_s

    def take(self, chars: int = 0, patience_s: float = math.inf) -> float:
        """Note one of so many characters; returns for how many seconds no more are to be read.

        One that would have to wait longer than `patience_s` is not noted: it is to be refused.
        """
        now = self._now()
        self._left = min(self._per_s * BURST_S, self._left + (now - self._at) * self._per_s)
        self._at = now
        left = self._left - 1 - chars // CHARS_OF_ONE
        wait_s = max(0.0, -left / self._per_s)
        if wait_s <= patience_s:
            self._left = left
        return wait_s


class Paces:
    """The pace of each of many, by a key; `most` of them, those that were heard last."""

    def __init__(
        self,
        per_s: float,
        now: Callable[[], float],
        held_back: Callable[[], None] = _nothing,
        sleep: Sleep = asyncio.sleep,
        most: int = 1000,
    ) -> None:
        self._new = partial(Pace, per_s, now, held_back, sleep)
        self._most = most
        # The one that was heard last is the last.
        self._paces: dict[str, Pace] = {}

    def of(self, key: str) -> Pace:
        pace = self._paces.pop(key, None) or self._new()
        self._paces[key] = pace
        if len(self._paces) > self._most:
            del self._paces[next(iter(self._paces))]
        return pace
