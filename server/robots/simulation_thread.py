"""The thread in which robots work that are simulated in the service's own process."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")


class SimulationThread:
    """Lets one robot work after the other, a slice of time each, beside the event loop.

    One thread for all: they would only take the interpreter's lock from each other, and the more
    of them want it, the longer the loop waits for its turn.
    """

    def __init__(self) -> None:
        self._executor = ThreadPoolExecutor(1, "simulation")

    async def __call__(self, work: Callable[[], T]) -> T:
        """Do it when those before have had their turn. Raises what it raises."""
        return await asyncio.get_running_loop().run_in_executor(self._executor, work)

    def close(self) -> None:
        """Let nobody work any more; what is under way goes on to its end."""
        self._executor.shutdown(wait=False, cancel_futures=True)
