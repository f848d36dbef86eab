"""Who has promised help says that it is done, or cannot give it after all."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.dialogue.calls import ConversationPhase
from mend.dialogue.conversation import MOST_LOOKS, Conversation
from mend.dialogue.evidence import Change
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, AwaitHelp, Close, Felt, Remark, Sight
from mend.errors import IllegalTransitionError
from mend.tasks.issue import Issue, Sensed

SCRIPTS = load_scripts()
LAST = Outlook(attempt=3, failed=Sequel(Next.RUN_FAILS), times=2)


def conversation_about(
    kind: str, outlook: Outlook | None = None, sensed: Sensed = Sensed.SEEN
) -> Conversation:
    issue = Issue(
        kind=kind,
        robot="pr2",
        node="/0",
        name="place_cup",
        object="cup",
        place="cup_place",
        step=5,
        item="mail",
        person="anna",
        sensed=sensed,
        guesses=("at 101", "at 102"),
    )
    conversation = Conversation(SCRIPTS[kind], issue, outlook or Outlook())
    conversation.open()
    return conversation


def promised(kind: str, outlook: Outlook | None = None) -> Conversation:
    """A helper has said yes to the first question."""
    conversation = conversation_about(kind, outlook)
    conversation.answer("yes")
    assert conversation.phase is ConversationPhase.AWAITING_HELP
    return conversation


def test_at_the_word_that_it_is_done_nothing_is_said_before_a_look() -> None:
    conversation = promised("missed")
    assert conversation.said_done() == []
    assert conversation.phase is ConversationPhase.LOOKING_AGAIN


def test_help_that_is_seen_at_a_word_is_thanked_for_as_always() -> None:
    told, untold = promised("missed"), promised("missed")
    told.said_done()
    assert told.help_seen(Change.MOVED) == untold.help_seen(Change.MOVED)


def test_a_word_without_a_change_is_no_help() -> None:
    conversation = promised("missed")
    conversation.said_done()
    remark, close = conversation.help_seen(Change.NONE)
    assert isinstance(remark, Remark)
    assert "Thank you" not in remark.text
    assert isinstance(close, Close)
    assert not close.helped


@pytest.mark.parametrize(
    ("sight", "said"),
    [
        (None, "I do not see the cup where I can reach it yet. I keep watching."),
        (
            Sight.NOWHERE,
            "I do not see the cup where I can reach it yet. I do not see it at all. "
            "I keep watching.",
        ),
        (
            Sight.UNMOVED,
            "I do not see the cup where I can reach it yet. I see it where it was after I asked. "
            "I keep watching.",
        ),
        (
            Sight.ELSEWHERE,
            "I do not see the cup where I can reach it yet. I see it, but not there. "
            "I keep watching.",
        ),
    ],
)
def test_what_is_not_seen_yet_is_said_with_what_is_seen_instead(
    sight: Sight | None, said: str
) -> None:
    conversation = promised("missed")
    conversation.said_done()
    assert conversation.not_seen_yet(sight=sight) == [Remark(said)]
    assert conversation.phase is ConversationPhase.AWAITING_HELP


def test_a_basket_tells_what_it_feels_instead() -> None:
    conversation = promised("item_not_given")
    conversation.said_done()
    assert conversation.not_seen_yet(Felt.TOO_LITTLE) == [
        Remark(
            "I feel very little that is new in my basket, too little for the mail. I keep watching."
        )
    ]


def test_who_can_see_nothing_says_so() -> None:
    conversation = promised("missed")
    conversation.said_done()
    assert conversation.not_seen_yet(blind="the picture is black") == [
        Remark("The picture is black. I cannot see whether anybody has helped. I keep watching.")
    ]


def test_while_the_robot_looks_at_a_word_it_takes_no_other() -> None:
    conversation = promised("missed")
    conversation.said_done()
    assert not conversation.looks_at_a_word
    with pytest.raises(IllegalTransitionError):
        conversation.said_done()


def test_the_robot_looks_at_a_word_only_so_often() -> None:
    conversation = promised("missed")
    for _ in range(MOST_LOOKS):
        conversation.said_done()
        conversation.not_seen_yet()
    assert not conversation.looks_at_a_word
    with pytest.raises(ValueError, match="often enough"):
        conversation.said_done()
    conversation.help_not_seen()
    conversation.answer("yes")
    assert conversation.looks_at_a_word


def test_who_told_where_the_robot_is_has_nothing_to_do() -> None:
    conversation = promised("lost")
    with pytest.raises(ValueError, match="looks already"):
        conversation.said_done()


@pytest.mark.parametrize("outlook", [Outlook(), LAST])
@pytest.mark.parametrize("kind", sorted(SCRIPTS))
def test_a_promise_taken_back_leads_where_a_no_to_it_leads(kind: str, outlook: Outlook) -> None:
    taken_back, refused = conversation_about(kind, outlook), conversation_about(kind, outlook)
    for each in (taken_back, refused):
        each.answer("yes")
    if taken_back.phase is not ConversationPhase.AWAITING_HELP or kind == "lost":
        return
    assert isinstance(refused.help_not_seen()[-1], Ask)
    assert taken_back.take_back() == refused.answer("no")


def test_who_was_wrong_about_where_the_robot_is_is_asked_on() -> None:
    [asked] = promised("lost").take_back()
    assert isinstance(asked, Ask)
    assert asked.text == "Am I at 102?"


@given(
    kind=st.sampled_from(sorted(SCRIPTS)),
    sensed=st.sampled_from(Sensed),
    outlook=st.sampled_from([Outlook(), LAST]),
    calls=st.lists(st.sampled_from(["yes", "no", "not seen", "done", "not yet", "cannot"])),
)
@settings(deadline=None)
def test_a_word_and_a_promise_taken_back_are_for_where_help_is_awaited_alone(
    kind: str, sensed: Sensed, outlook: Outlook, calls: list[str]
) -> None:
    conversation = conversation_about(kind, outlook, sensed)
    takes = {
        "yes": lambda: conversation.answer("yes"),
        "no": lambda: conversation.answer("no"),
        "not seen": conversation.help_not_seen,
        "done": conversation.said_done,
        "not yet": conversation.not_seen_yet,
        "cannot": conversation.take_back,
    }
    for call in calls:
        phase, looks = conversation.phase, conversation.looks_at_a_word
        try:
            turns = takes[call]()
        except (IllegalTransitionError, ValueError):
            assert conversation.phase is phase
            assert call != "done" or not looks
            continue
        match call:
            case "done":
                assert looks
                assert (turns, conversation.phase) == ([], ConversationPhase.LOOKING_AGAIN)
            case "not yet":
                assert phase is ConversationPhase.LOOKING_AGAIN
                assert [type(each) for each in turns] == [Remark]
            case "cannot":
                assert phase in (ConversationPhase.AWAITING_HELP, ConversationPhase.LOOKING_AGAIN)
                # Which question comes next, or that none does; a promise is never asked for twice.
                assert not isinstance(turns[-1], AwaitHelp)
