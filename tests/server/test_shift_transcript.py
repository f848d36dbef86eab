"""Each line of a shift has the moment before it at which that happened, by the site's clock."""

import pytest
from fleet_events import LegMaker, asked

from mend.fleet.requests import LegAction
from mend.server.cli.shift_transcript import ShiftTranscript
from mend.server.journal import events as ev

RUN = LegMaker("r1", 1, "tea", LegAction.HAND_OVER).run()


def printed(capsys: pytest.CaptureFixture[str], *events: ev.Event) -> list[str]:
    told = ShiftTranscript(["tea"])
    for each in events:
        told.tell(each)
    return capsys.readouterr().out.splitlines()


def test_a_run_that_begins_long_after_the_line_before_is_told_when_it_does(
    capsys: pytest.CaptureFixture[str],
) -> None:
    started = RUN.started().model_copy(update={"at_s": 6300.0})
    lines = printed(capsys, asked("tea", "under_way", 5983.0), started, RUN.lost(3.9))
    assert [each[:8] for each in lines] == ["  5983.0", "  6300.0", "  6303.9"]
    assert lines[1].endswith("r1 begins to go")


def test_a_run_of_an_older_journal_begins_with_the_line_before_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    lines = printed(capsys, asked("tea", "under_way", 5983.0), RUN.started(), RUN.lost(3.9))
    assert [each[:8] for each in lines] == ["  5983.0", "  5983.0", "  5986.9"]


def test_what_whoever_follows_it_says_is_told_when_they_do(
    capsys: pytest.CaptureFixture[str],
) -> None:
    told = ShiftTranscript(["tea"])
    told.tell(asked("tea", "booked", 74.0))
    told.say("no robot fails", 1850.0)
    told.refused("tea", "it is too late", 1851.0)
    assert [each[:8] for each in capsys.readouterr().out.splitlines()] == [
        "    74.0",
        "  1850.0",
        "  1851.0",
    ]
