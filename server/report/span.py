"""Which part of a journal a report tells of: from a moment on, and until another."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime

from mend.errors import WrongInputError
from mend.server.journal import events as ev

Moment = datetime | float
"""A time of the calendar, or seconds of the site's clock."""


@dataclass(frozen=True, slots=True)
class Span:
    """From `begin` until just before `end`; None is all there is."""

    begin: Moment | None = None
    end: Moment | None = None

    @classmethod
    def read(cls, begin: str | None, end: str | None) -> "Span":
        """What `--from` and `--until` say. Raises `WrongInputError`."""
        span = cls(_moment("--from", begin), _moment("--until", end))
        match span.begin, span.end:
            case (float() as since, float() as until) if until <= since:
                raise WrongInputError(f"--until ({until:g} s) must be after --from ({since:g} s)")
            case (datetime() as since, datetime() as until) if until <= since:
                raise WrongInputError(f"--until ({until}) must be after --from ({since})")
        return span

    def up_to_end(self, events: Iterable[ev.Event]) -> Iterator[tuple[ev.Event, bool]]:
        """The events before the span's end, in order, each with whether it is in the span.

        A run's own events tell no site's clock: by that they are when the fleet's around them are.
        """
        begun = self.begin is None
        for event in events:
            if self.end is not None and _has_come(self.end, event):
                return
            begun = begun or (self.begin is not None and _has_come(self.begin, event))
            yield event, begun


def _has_come(moment: Moment, event: ev.Event) -> bool:
    if isinstance(moment, datetime):
        return event.wall_time >= moment
    return isinstance(event, ev.FleetEvent) and event.at_s >= moment


def _moment(option: str, text: str | None) -> Moment | None:
    if text is None:
        return None
    try:
        seconds = float(text)
    except ValueError:
        return _date(option, text)
    if not math.isfinite(seconds) or seconds < 0.0:
        raise WrongInputError(f"{option} must be at least 0 s of the site's clock, not '{text}'")
    return seconds


def _date(option: str, text: str) -> datetime:
    """What names no zone is this machine's time."""
    try:
        return datetime.fromisoformat(text).astimezone()
    except (ValueError, OverflowError, OSError) as error:
        raise WrongInputError(
            f"{option} must be a time as 2026-11-28T09:00, or seconds of the site's clock, "
            f"not '{text}'"
        ) from error
