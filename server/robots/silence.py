"""How long nothing was heard of somebody, not counting when we were not there to hear it."""

from collections.abc import Callable

LATE = 2.0
"""A look that comes after so many times what was to pass until it is late."""


class Silence:
    """Counted from one look to the next, which are to come `period_s` apart.

    A look that is late adds nothing: the process was stopped, or had no time, and what was sent
    meanwhile is still to be read. `clock` is any monotonic clock in seconds.
    """

    def __init__(self, clock: Callable[[], float], period_s: float) -> None:
        self._clock = clock
        self._period_s = period_s
        self._looked = clock()
        self._heard = False
        self.seconds = 0.0

    def hear(self) -> None:
        """Something came."""
        self._heard = True
        self.seconds = 0.0

    def look(self) -> float:
        """Count what has passed; returns for how long nothing has come."""
        now = self._clock()
        self.seconds, self._looked, self._heard = self._until(now), now, False
        return self.seconds

    def so_far(self) -> float:
        """For how long nothing has come, between two looks."""
        return self._until(self._clock())

    def _until(self, now: float) -> float:
        passed_s = now - self._looked
        counts = not self._heard and passed_s <= LATE * self._period_s
        return self.seconds + passed_s if counts else self.seconds
