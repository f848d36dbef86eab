"""A span is read from what people write, and cuts a journal there."""

from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from fleet_events import LegMaker, asked
from hypothesis import given
from hypothesis import strategies as st

from mend.errors import WrongInputError
from mend.fleet.requests import LegAction
from mend.server.report.span import Span


@pytest.mark.parametrize(
    ("begin", "until", "why"),
    [
        ("yesterday", None, "--from must be a time as"),
        (None, "-3", "--until must be at least 0 s"),
        (None, "nan", "--until must be at least 0 s"),
        ("inf", None, "--from must be at least 0 s"),
        ("20", "20", "--until .* must be after --from"),
        ("2026-01-02T10:00Z", "2026-01-02T09:00+00:00", "--until .* must be after --from"),
        ("2026-13-01", None, "--from must be a time as"),
        ("0001-01-01", None, "--from must be a time as"),
    ],
)
def test_nonsense_is_refused_with_a_sentence(
    begin: str | None, until: str | None, why: str
) -> None:
    with pytest.raises(WrongInputError, match=why):
        Span.read(begin, until)


def test_times_of_the_calendar_and_of_the_sites_clock_are_read() -> None:
    assert Span.read("0", "1e3") == Span(0.0, 1000.0)
    assert Span.read("2026-01-02T10:00Z", None).begin == datetime(2026, 1, 2, 10, tzinfo=UTC)
    local = Span.read("2026-01-02T10:00", None).begin
    assert isinstance(local, datetime)
    assert local == datetime(2026, 1, 2, 10).astimezone()


moments = st.floats(0.0, 1000.0)


@given(st.lists(moments, max_size=20), moments, st.floats(1e-3, 500.0))
def test_what_is_in_a_span_is_what_happened_in_it(
    times: list[float], begin: float, lasts_s: float
) -> None:
    events = [asked("tea", "booked", at_s) for at_s in sorted(times)]
    span = Span(begin, begin + lasts_s)
    within = [each.at_s for each, inside in span.up_to_end(events) if inside]  # type: ignore[attr-defined]
    assert within == [each for each in sorted(times) if begin <= each < begin + lasts_s]


def test_a_run_has_no_clock_of_the_site_and_is_when_the_fleet_around_it_is() -> None:
    leg = LegMaker("r0", 1, "tea", LegAction.VISIT)
    step = leg.run().step(3.0, None)
    events: list[Any] = [leg.begun(10.0), step, leg.ended(20.0), step]
    assert [inside for _, inside in Span(15.0, None).up_to_end(events)] == [
        False,
        False,
        True,
        True,
    ]


def test_the_calendar_counts_for_every_event() -> None:
    step = LegMaker("r0", 1, "tea", LegAction.VISIT).run().step(3.0, None)
    at = step.wall_time
    assert list(Span(at, None).up_to_end([step])) == [(step, True)]
    assert list(Span(at + timedelta(seconds=1), None).up_to_end([step])) == [(step, False)]
    assert list(Span(None, at).up_to_end([step])) == []
