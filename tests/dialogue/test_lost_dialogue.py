"""The dialogue of a robot that is lost: what it asks, and what it believes."""

from dataclasses import replace

import pytest

from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change, PutRight
from mend.dialogue.outlook import Outlook
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import (
    Ask,
    AwaitHelp,
    Close,
    CloseReason,
    Expectation,
    Help,
    Remark,
    Turn,
)
from mend.tasks.issue import Issue, Sensed
from mend.tasks.resolution import Resolution

TWO = ("at F1-101", "near F1-103")


def about(*guesses: str, **more: str) -> Conversation:
    issue = Issue(
        kind="lost",
        robot="robot1",
        node="/0",
        name="rounds",
        object=None,
        place="F1-102",
        step=1,
        reason="what I see fits no place for sure"
        if guesses
        else "what I see fits no place that I know",
        sensed=Sensed.BY_LASER,
        guesses=guesses,
    )
    return Conversation(load_scripts()["lost"], replace(issue, **more), Outlook())


def said(turns: list[Turn]) -> list[str]:
    return [each.text for each in turns if isinstance(each, Ask | Remark)]


def test_it_asks_about_the_likeliest_place_first() -> None:
    assert said(about(*TWO).open()) == [
        "I do not know where I am. What I see fits no place for sure. Am I at F1 101?"
    ]


def test_a_yes_is_held_against_what_it_sees_before_it_counts() -> None:
    conversation = about(*TWO)
    conversation.open()
    assert conversation.answer("yes") == [AwaitHelp(Help.TELL_PLACE, "at F1-101")]
    turns = conversation.help_seen(Change.TOLD)
    assert said(turns) == ["Thank you. What I see agrees: I am at F1 101. I go on."]
    assert turns[-1] == Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, helped=True)


def test_a_yes_that_what_it_sees_speaks_against_is_not_believed() -> None:
    conversation = about(*TWO)
    conversation.open()
    conversation.answer("yes")
    assert said(conversation.help_not_seen()) == [
        "What I see does not agree with my being at F1 101.",
        "Am I near F1 103?",
    ]


def test_after_the_last_guess_it_asks_whether_to_leave_it_out() -> None:
    conversation = about(*TWO)
    conversation.open()
    conversation.answer("no")
    turns = conversation.answer("no")
    assert said(turns) == [
        "I do not know where I am, and cannot go on. Shall I leave the drive to F1 102 out?"
    ]
    assert conversation.answer("yes")[-1] == Close(CloseReason.LEFT_OUT, None, helped=False)


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"item": "cup_of_tea"}, "the cup of tea"),
        ({"message": "Lunch is ready"}, "the message for F1 102"),
        ({"person": "Ada"}, "the drive with Ada to F1 102"),
        ({"name": "meet_person", "person": "Ada"}, "the meeting with Ada at F1 102"),
    ],
)
def test_it_says_what_it_would_leave_out(more: dict[str, str], told: str) -> None:
    turns = about(**more).open()
    assert said(turns) == [f"I do not know where I am, and cannot go on. Shall I leave {told} out?"]


@pytest.mark.parametrize("guesses", [(), TWO])
def test_who_finds_out_alone_says_so_and_thanks_nobody(guesses: tuple[str, ...]) -> None:
    conversation = about(*guesses)
    conversation.open()
    assert conversation.watched_for == (Expectation.LOCATED,)
    turns = conversation.put_right(PutRight(Expectation.LOCATED, Change.NONE))
    assert said(turns) == ["I know where I am now. I go on."]
    assert turns[-1] == Close(CloseReason.WITHDRAWN, Resolution.ROBOT_FINISH, helped=False)


def test_without_a_guess_there_is_no_place_to_ask_about() -> None:
    [ask] = about().open()
    assert isinstance(ask, Ask)
    assert "Shall I leave" in ask.text


@pytest.mark.parametrize("guesses", [(), TWO[:1], TWO, (*TWO, "at hall")])
def test_nos_come_to_an_end(guesses: tuple[str, ...]) -> None:
    conversation = about(*guesses)
    turns, asked = conversation.open(), 0
    while not isinstance(turns[-1], Close):
        asked += 1
        turns = conversation.answer("no")
    assert asked == len(guesses) + 1
    assert turns[-1].resolution is Resolution.ROBOT_RETRY
