"""A wall clock that stands still."""

from datetime import UTC, datetime


def at_noon() -> datetime:
    return datetime(2026, 5, 1, 12, tzinfo=UTC)
