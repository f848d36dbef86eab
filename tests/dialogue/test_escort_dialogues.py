"""What is said of people whom robots escort: nobody is thanked who was not seen to come."""

import pytest

from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change, LookOutcome, PutRight, change_between, put_right
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, AwaitHelp, Close, CloseReason, Expectation, Help, Remark
from mend.tasks.issue import Issue
from mend.tasks.resolution import Resolution

SCRIPTS = load_scripts()
ESCORTING = ("person_not_there", "fell_behind")
BESIDE = frozenset({Expectation.ACCOMPANIED})


def conversation(kind: str, outlook: Outlook | None = None) -> Conversation:
    issue = Issue(
        kind=kind,
        robot="robot1",
        node="/0",
        name="escort",
        object=None,
        place="F1-101",
        step=2,
        reason="I have waited for 20 s",
        person="Jean-Luc {now}",
    )
    return Conversation(SCRIPTS[kind], issue, outlook or Outlook())


def asked(turns: list[object]) -> Ask:
    return next(each for each in turns if isinstance(each, Ask))


def said(turns: list[object]) -> str:
    return " ".join(each.text for each in turns if isinstance(each, Remark))


def closed(turns: list[object]) -> Close:
    return next(each for each in turns if isinstance(each, Close))


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (
            "person_not_there",
            "I have come to F1 101 for Jean-Luc {now}. I have waited for 20 s. "
            "Will you tell Jean-Luc {now} to come to me?",
        ),
        (
            "fell_behind",
            "Jean-Luc {now} does not come after me to F1 101. I have waited for 20 s. "
            "Will you tell Jean-Luc {now} to come?",
        ),
    ],
)
def test_a_person_is_called_as_they_are_called(kind: str, text: str) -> None:
    assert asked(list(conversation(kind).open())).text == text


@pytest.mark.parametrize("kind", ESCORTING)
def test_who_comes_after_a_promise_is_thanked_for_once_they_are_seen(kind: str) -> None:
    talk = conversation(kind)
    talk.open()
    turns = list(talk.answer("yes"))
    assert AwaitHelp(Help.SEND_PERSON) in turns
    assert "Thank" not in said(turns)
    turns = list(talk.help_seen(Change.CAME))
    assert said(turns) == "Thank you. I see Jean-Luc {now} beside me. I go on."
    assert closed(turns) == Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, helped=True)


@pytest.mark.parametrize("kind", ESCORTING)
def test_nobody_is_thanked_for_who_was_never_seen(kind: str) -> None:
    talk = conversation(kind)
    talk.open()
    talk.answer("yes")
    turns: list[object] = []
    while not any(isinstance(each, Close) for each in turns):
        turns = list(talk.help_not_seen())
        if not any(isinstance(each, Close) for each in turns):
            turns = list(talk.answer("yes"))
    assert "Thank" not in said(turns)
    assert said(turns).startswith("I still do not see Jean-Luc {now}.")
    assert closed(turns).reason is CloseReason.GAVE_UP
    assert closed(turns).failed


@pytest.mark.parametrize("kind", ESCORTING)
def test_what_nobody_answers_is_a_failed_attempt(kind: str) -> None:
    talk = conversation(kind, Outlook(attempt=3, failed=Sequel(Next.RUN_FAILS)))
    talk.open()
    turns = list(talk.silence())
    assert said(turns) == "I heard no answer. The task ends here, unfinished."
    assert closed(turns).failed


@pytest.mark.parametrize("kind", ESCORTING)
def test_who_refuses_twice_is_asked_whether_it_goes_on_without_them(kind: str) -> None:
    talk = conversation(kind, Outlook(attempt=2))
    talk.open()
    ask = asked(list(talk.answer("no")))
    assert ask.text == "Shall I go on without Jean-Luc {now}?"
    assert "left out by you" in ask.yes_effect
    turns = list(talk.answer("yes"))
    assert said(turns) == "All right. I go on without Jean-Luc {now}."
    assert closed(turns).reason is CloseReason.LEFT_OUT


def test_who_comes_near_tells_of_a_person_and_who_was_there_already_does_not() -> None:
    watched = (Expectation.ACCOMPANIED,)
    before, now = LookOutcome(frozenset(), None), LookOutcome(BESIDE, None)
    assert change_between(before, now) is Change.CAME
    assert Change.CAME.by_a_person
    assert put_right(watched, before, now) == PutRight(Expectation.ACCOMPANIED, Change.CAME)
    assert put_right(watched, now, now) is None


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("meet_person", "the meeting with Ada at F1 101"),
        ("escort_Ada", "the drive with Ada to F1 101"),
        ("go_to_F1-101", "the drive to F1 101"),
        ("rounds", "the rounds"),
    ],
)
def test_what_would_be_left_out_is_said_as_people_say_it(name: str, told: str) -> None:
    person = None if name.startswith(("go_to", "rounds")) else "Ada"
    issue = Issue("blocked", "robot1", "/0", name, None, "F1-101", 2, person=person)
    talk = Conversation(SCRIPTS["blocked"], issue, Outlook(attempt=2))
    talk.open()
    assert asked(talk.answer("no")).text == f"Shall I leave {told} out?"
