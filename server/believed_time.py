"""The time of day where it must not be believed at once that much of it has passed."""

import logging
from collections.abc import Callable
from datetime import datetime, timedelta

log = logging.getLogger(__name__)

LEAP = timedelta(days=1)
"""So far ahead of what has passed a clock is not believed at once."""
DOUBT_S = 86_400.0
"""For so long; then a machine that was off, rather than a wrong clock, is believed."""


class BelievedTime:
    """A wall clock without its leaps ahead, each of which is believed only after a day.

    `since` is when it last is known to have been right, None for now. `monotonic` is any clock in
    seconds that nobody sets.
    """

    def __init__(
        self,
        utc_now: Callable[[], datetime],
        monotonic: Callable[[], float],
        since: datetime | None,
    ) -> None:
        self._utc_now = utc_now
        self._monotonic = monotonic
        self._believed = since or utc_now()
        self._at = monotonic()
        self._leapt_at: float | None = None

    def __call__(self) -> datetime:
        """The time now, or where that is too far ahead what it would be without the leap."""
        now, at = self._utc_now(), self._monotonic()
        passed = self._believed + timedelta(seconds=at - self._at)
        self._at = at
        if now <= passed + LEAP:
            self._believed, self._leapt_at = now, None
        elif self._leapt_at is None:
            log.warning("the clock is %s ahead; it is believed in a day from now", now - passed)
            self._believed, self._leapt_at = passed, at
        elif at - self._leapt_at >= DOUBT_S:
            self._believed, self._leapt_at = now, None
        else:
            self._believed = passed
        return self._believed
