"""A clock that leaps ahead is not believed at once where what follows cannot be taken back."""

from datetime import UTC, datetime, timedelta

from mend.server.believed_time import DOUBT_S, LEAP, BelievedTime

NOON = datetime(2026, 5, 4, 12, tzinfo=UTC)


class Clocks:
    """A wall clock that can be set, and one that cannot."""

    def __init__(self) -> None:
        self.wall = NOON
        self.passed_s = 0.0

    def pass_s(self, seconds: float) -> None:
        self.wall += timedelta(seconds=seconds)
        self.passed_s += seconds

    def believed(self, since: datetime | None = None) -> BelievedTime:
        return BelievedTime(lambda: self.wall, lambda: self.passed_s, since)


def test_time_that_passes_is_believed() -> None:
    clocks = Clocks()
    believed = clocks.believed()
    for _ in range(400):
        clocks.pass_s(86_400.0)
        assert believed() == clocks.wall


def test_a_night_since_the_last_run_is_believed_and_a_year_only_after_a_day() -> None:
    clocks = Clocks()
    assert clocks.believed(since=NOON - LEAP)() == NOON
    long_ago = NOON - timedelta(days=365)
    believed = clocks.believed(since=long_ago)
    assert believed() == long_ago
    clocks.pass_s(DOUBT_S - 1.0)
    assert believed() == long_ago + timedelta(seconds=DOUBT_S - 1.0)
    clocks.pass_s(1.0)
    assert believed() == clocks.wall


def test_a_clock_that_is_set_right_within_a_day_has_done_no_harm() -> None:
    clocks = Clocks()
    believed = clocks.believed()
    clocks.wall += timedelta(days=400)
    for _ in range(23):
        clocks.pass_s(3600.0)
        assert believed() == clocks.wall - timedelta(days=400)
    clocks.wall -= timedelta(days=400)
    assert believed() == clocks.wall
    clocks.wall += timedelta(days=400)
    clocks.pass_s(7200.0)
    assert believed() == clocks.wall - timedelta(days=400), "it is doubted for a day once more"


def test_a_clock_that_is_set_back_is_believed() -> None:
    clocks = Clocks()
    believed = clocks.believed()
    clocks.wall -= timedelta(days=30)
    assert believed() == clocks.wall
