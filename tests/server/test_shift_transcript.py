"""Each line of a shift has the moment before it at which that happened, by the site's clock."""

from datetime import UTC, datetime
from math import inf

import pytest
from fleet_events import SITE, LegMaker, asked

from mend.fleet.requests import LegAction
from mend.robots.link.messages import LASER, Detection
from mend.server.cli.shift_transcript import ShiftTranscript
from mend.server.journal import events as ev
from mend.tasks.intervention import Act, Intervention

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


def test_what_people_do_while_no_robot_has_a_task_is_told(
    capsys: pytest.CaptureFixture[str],
) -> None:
    barred = ev.SiteIntervention(
        wall_time=datetime(2026, 1, 1, tzinfo=UTC),
        site=SITE,
        at_s=7.0,
        intervention=Intervention(act=Act.BAR, between=("F1/a", "F1/b")),
        by="scenario",
    )
    in_vain = barred.model_copy(update={"ok": False, "detail": "somebody is there"})
    told = "     7.0    person (scenario): bars the way between F1/a and F1/b"
    assert printed(capsys, barred, in_vain) == [told, f"{told}: in vain, somebody is there"]


def test_a_wrong_floor_is_one_of_the_elevator_that_the_robot_names() -> None:
    told = ShiftTranscript(["tea"])
    opened = Detection(camera=LASER, explanation="lift1 has opened at F3, and I must get to F2")
    raised = RUN.raised(9.0, "wrong_floor").model_copy(update={"detection": opened})
    for each in (RUN.started().model_copy(update={"at_s": 100.0}), raised):
        told.tell(each)
    assert told.was_at_wrong_floor("lift1", 50.0)
    assert not told.was_at_wrong_floor("lift1", 110.0)
    assert not told.was_at_wrong_floor("lift", 50.0)


def test_that_nobody_was_silent_is_told_with_who_was_at_what_since_when() -> None:
    told, leg = ShiftTranscript(["tea"]), LegMaker("r1", 1, "tea", LegAction.HAND_OVER)
    told.tell(leg.begun(400.0))
    assert told.why_nobody_was_silent(300.0, 450.0) is None
    assert told.why_nobody_was_silent(500.0, 600.0) == (
        "nobody left a question unanswered from 500 to 600 s, as no leg began then: "
        f"r1 was at 'tea' at {leg.begun(400.0).place} since 400 s"
    )
    told.tell(leg.ended(700.0))
    assert told.why_nobody_was_silent(800.0, inf) == (
        "nobody left a question unanswered from 800 s on, as no leg began then: "
        "no robot was at anything"
    )
