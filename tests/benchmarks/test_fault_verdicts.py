"""What a trial with a fault is counted as: by what is said first, if that is so, and in time."""

import pytest
from fault_kinds import KINDS, Verdict, latency_ms, verdict
from fault_trial import Moment, Said, Trial


def trial(kind: str, *said: Said, **known: object) -> Trial:
    made = Trial(1, "part_1", kind, Moment(4, 0.5), said=list(said), fault_s=10.0)
    for name, value in known.items():
        setattr(made, name, value)
    return made


def say(issue: str, time_s: float = 10.1, *, true: bool = True) -> Said:
    return Said(issue, time_s, "", true)


def test_every_kind_of_fault_is_played() -> None:
    assert len(KINDS) == 11


def test_what_names_the_fault_and_is_so_is_right() -> None:
    found = trial("vanish", say("dropped"))
    assert verdict(found) is Verdict.RIGHT
    assert latency_ms(found) == pytest.approx(100.0)


@pytest.mark.parametrize("said", [say("missed"), say("dropped", true=False)])
def test_another_name_and_what_is_not_so_are_wrong(said: Said) -> None:
    assert verdict(trial("vanish", said, say("dropped"))) is Verdict.WRONG


def test_nothing_said_is_silent_unless_the_part_was_placed_all_the_same() -> None:
    assert verdict(trial("pushed aside")) is Verdict.SILENT
    assert verdict(trial("pushed aside", finished=True)) is Verdict.SILENT
    assert verdict(trial("pushed aside", finished=True, placed=True)) is Verdict.NO_EFFECT


def test_what_is_finished_without_its_part_is_silent_whatever_was_said() -> None:
    assert verdict(trial("pushed aside", say("undone"), finished=True)) is Verdict.SILENT


def test_what_is_said_before_the_fault_is_not_about_it() -> None:
    assert verdict(trial("drop", say("dropped", 9.9))) is Verdict.BEFORE


@pytest.mark.parametrize(
    ("out_s", "said", "expected"),
    [
        (10.2, (say("dropped", 10.3),), Verdict.RIGHT),
        (11.0, (say("dropped", 11.1),), Verdict.WITHSTOOD),
        (None, (), Verdict.WITHSTOOD),
        (10.2, (), Verdict.SILENT),
    ],
)
def test_only_a_pull_that_the_fingers_withstand_for_long_may_stay_unnoticed(
    out_s: float | None, said: tuple[Said, ...], expected: Verdict
) -> None:
    assert verdict(trial("pull", *said, out_s=out_s)) is expected
