"""Things that may happen any number of times, told to the log now and then."""

import logging
from collections.abc import Callable
from dataclasses import dataclass

EVERY_S = 60.0


@dataclass(slots=True)
class _LastTold:
    at: float
    times_since: int = 0


class RareLog:
    """Warns of each subject at most once a minute, however often there is reason to."""

    def __init__(self, log: logging.Logger, monotonic: Callable[[], float]) -> None:
        self._log = log
        self._monotonic = monotonic
        self._told: dict[str, _LastTold] = {}

    def warn(self, subject: str, sentence: str, error: Exception | None = None) -> None:
        """Log the sentence, unless one about this subject was logged within the last minute.

        With an `error` it is logged where that came from, too.
        `subject` is one of few: each is remembered.
        """
        now = self._monotonic()
        told = self._told.get(subject)
        if told is not None and now - told.at < EVERY_S:
            told.times_since += 1
            return
        more = f" ({told.times_since} times more since last told)" if told else ""
        self._told[subject] = _LastTold(now)
        rest = more if told and told.times_since else ""
        self._log.warning("%s%s", sentence, rest, exc_info=error)
