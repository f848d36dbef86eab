"""How fast a client is listened to: one that floods waits, and nobody else does."""

from collections.abc import Callable

CHARS_OF_ONE = 4096
"""A longer message counts as one for each such part."""

BURST_S = 4.0
"""What was not said for so long may come at once."""


class Pace:
    """Lets through `per_s` messages a second; `now` is any monotonic clock in seconds."""

    def __init__(self, per_s: float, now: Callable[[], float]) -> None:
        self._per_s = per_s
        self._now = now
        self._left = per_s * BURST_S
        self._at = now()

    def take(self, message: str | bytes) -> float:
        """Note one that came; returns for how many seconds nothing more is to be read."""
        now = self._now()
        self._left = min(self._per_s * BURST_S, self._left + (now - self._at) * self._per_s)
        self._at = now
        self._left -= 1 + len(message) // CHARS_OF_ONE
        return max(0.0, -self._left / self._per_s)
