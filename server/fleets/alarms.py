"""Moments of a site's clock that somebody waits for."""

import asyncio
from collections.abc import Callable

LOOKS_EVERY_S = 0.2
"""While all robots are in runs, the clock is looked at that often (wall time)."""


class Alarms:
    """Wakes those who wait for a moment once `now_s` has come to it."""

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self._waiting: list[tuple[float, asyncio.Event]] = []

    @property
    def next_s(self) -> float | None:
        """The first moment that anybody waits for."""
        return min((moment_s for moment_s, _ in self._waiting), default=None)

    def ring(self) -> None:
        """Wake whose moment has come."""
        now_s = self._now_s()
        for moment_s, event in self._waiting:
            if now_s >= moment_s:
                event.set()

    async def wait(self, moment_s: float) -> None:
        """Wait until the clock has come to a moment."""
        waiting = moment_s, asyncio.Event()
        self._waiting.append(waiting)
        try:
            while self._now_s() < moment_s:
                try:
                    await asyncio.wait_for(waiting[1].wait(), LOOKS_EVERY_S)
                except TimeoutError:
                    continue
        finally:
            self._waiting.remove(waiting)
