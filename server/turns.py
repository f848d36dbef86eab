"""Long work within the event loop, in pieces between which everybody else has their turn."""

import asyncio
import time
from collections.abc import Callable

LONGEST_S = 0.005


class Turns:
    """How long the loop has not been given back. `clock` is any monotonic clock, in seconds."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self._began = clock()

    async def pass_on(self) -> None:
        """Let others have their turn, if it has been ours for long; to be called between pieces."""
        if self._clock() - self._began >= LONGEST_S:
            await asyncio.sleep(0)
            self._began = self._clock()
