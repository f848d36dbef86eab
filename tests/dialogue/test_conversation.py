"""A conversation walks a sound script and closes exactly once, whatever it is told."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.dialogue.calls import ConversationPhase
from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change, PutRight
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import (
    Ask,
    AwaitHelp,
    Close,
    CloseReason,
    Expectation,
    Felt,
    Help,
    Remark,
    Turn,
)
from mend.errors import IllegalTransitionError
from mend.tasks.issue import Issue, Sensed
from mend.tasks.resolution import Resolution

SCRIPTS = load_scripts()

FIRST = Outlook()
AGAIN = Outlook(attempt=2, times=2, unchanged=2)
THIRD = Outlook(attempt=3, failed=Sequel(Next.RUN_FAILS), times=3, unchanged=3)

Call = Callable[[Conversation], list[Turn]]

CALLS: dict[str, Call] = {
    "open": Conversation.open,
    "yes": lambda conversation: conversation.answer("yes"),
    "no": lambda conversation: conversation.answer("no"),
    "seen": lambda conversation: conversation.help_seen(Change.MOVED),
    "seen as before": lambda conversation: conversation.help_seen(Change.NONE),
    "seen, not before": lambda conversation: conversation.help_seen(Change.UNKNOWN),
    "seen at place": lambda conversation: conversation.help_seen(Change.MOVED, at_place=True),
    "seen at place, as before": lambda conversation: conversation.help_seen(
        Change.NONE, at_place=True
    ),
    "not seen": Conversation.help_not_seen,
    "done": Conversation.said_done,
    "not yet": Conversation.not_seen_yet,
    "cannot": Conversation.take_back,
    "at place": lambda conversation: conversation.put_right(
        PutRight(Expectation.AT_PLACE, Change.MOVED)
    ),
    "at place, nobody seen": lambda conversation: conversation.put_right(
        PutRight(Expectation.AT_PLACE, Change.NONE)
    ),
    "in reach": lambda conversation: conversation.put_right(
        PutRight(Expectation.IN_REACH, Change.MOVED)
    ),
    "in reach, nobody seen": lambda conversation: conversation.put_right(
        PutRight(Expectation.IN_REACH, Change.NONE)
    ),
    "way clear": lambda conversation: conversation.put_right(
        PutRight(Expectation.WAY_CLEAR, Change.MOVED)
    ),
    "way clear, nobody seen": lambda conversation: conversation.put_right(
        PutRight(Expectation.WAY_CLEAR, Change.NONE)
    ),
    "silence": Conversation.silence,
    "abort": Conversation.abort,
}


def conversation_about(
    kind: str, outlook: Outlook = FIRST, *, felt: bool = False, reason: str = ""
) -> Conversation:
    issue = Issue(
        kind=kind,
        robot="pr2",
        node="/1/0",
        name="place_pink_bar",
        object="pink_bar",
        place="pink_bar_place",
        step=5,
        sensed=Sensed.FELT if felt else Sensed.SEEN,
        reason=reason,
    )
    return Conversation(SCRIPTS[kind], issue, outlook)


def walk(kind: str, *calls: str, outlook: Outlook = FIRST, felt: bool = False) -> list[Turn]:
    """All turns of a conversation that is opened and told these things."""
    conversation = conversation_about(kind, outlook, felt=felt)
    turns = conversation.open()
    for call in calls:
        turns += CALLS[call](conversation)
    return turns


FAILED_RETRY = Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, False, failed=True)
GOES_ON = Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, False)


def shape(turns: list[Turn]) -> str:
    """The kinds of turns in order, as in 'Ask Say AwaitHelp'."""
    return " ".join(type(turn).__name__ for turn in turns)


@pytest.mark.parametrize("kind", ["missed", "dropped"])
@pytest.mark.parametrize(
    ("calls", "close"),
    [
        (["yes", "seen"], Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, True)),
        (["no", "yes", "seen"], Close(CloseReason.RESOLVED, Resolution.HUMAN_FINISH, True)),
        (["no", "no"], Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, False, failed=True)),
        (["at place"], Close(CloseReason.WITHDRAWN, Resolution.HUMAN_FINISH, True)),
        (["in reach"], Close(CloseReason.WITHDRAWN, Resolution.ROBOT_RETRY, True)),
        (["silence"], Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False, failed=True)),
        (["no", "silence"], Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False, failed=True)),
        (["yes", "seen as before"], FAILED_RETRY),
        (["no", "yes", "seen as before"], GOES_ON),
        (["at place, nobody seen"], Close(CloseReason.WITHDRAWN, Resolution.ROBOT_FINISH, False)),
        (
            ["in reach, nobody seen"],
            Close(CloseReason.WITHDRAWN, Resolution.ROBOT_RETRY, False, failed=True),
        ),
        (["abort"], Close(CloseReason.ABORTED, None, False)),
    ],
)
def test_a_lost_part_is_put_back_or_placed_by_the_helper_or_tried_again_later(
    kind: str, calls: list[str], close: Close
) -> None:
    assert walk(kind, *calls)[-1] == close


def test_who_hands_over_another_part_hears_that_it_does_not_look_like_it() -> None:
    conversation = conversation_about("unreachable")
    conversation.open()
    conversation.answer("yes")
    (asked,) = conversation.help_not_seen(Felt.ANOTHER)
    assert isinstance(asked, Ask)
    assert asked.text == (
        "What I was handed does not look like the pink bar. Are you still handing it over?"
    )


@pytest.mark.parametrize(
    ("kind", "felt", "asked"),
    [
        ("unreachable", False, ["I cannot do the tap. It is far. Shall I leave the tap out?"]),
        (
            "blocked",
            False,
            [
                "I cannot go on. It is far. Can you clear the way?",
                "Shall I leave the tap out?",
            ],
        ),
        (
            "blocked",
            True,
            [
                "I felt something hold up my arm and stopped. Can you clear its way?",
                "Shall I leave the tap out?",
            ],
        ),
    ],
)
def test_nobody_is_asked_to_hand_over_or_place_where_a_leaf_handles_nothing(
    kind: str, felt: bool, asked: list[str]
) -> None:
    sensed = Sensed.FELT if felt else Sensed.SEEN
    issue = Issue(
        kind=kind,
        robot="pr2",
        node="/0",
        name="tap",
        object=None,
        place=None,
        step=0,
        reason="it is far",
        sensed=sensed,
    )
    for outlook in (AGAIN, THIRD):
        conversation = Conversation(SCRIPTS[kind], issue, outlook)
        turns = conversation.open()
        while conversation.phase is ConversationPhase.ASKING:
            turns += conversation.answer("no")
        asks = [turn for turn in turns if isinstance(turn, Ask)]
        told = [text for ask in asks for text in (ask.text, ask.yes_effect, ask.no_effect)]
        assert not any("place the" in text or "hand" in text for text in told), told
        if outlook is AGAIN:
            assert [ask.text for ask in asks] == asked


@pytest.mark.parametrize("kind", ["missed", "dropped", "missing", "undone"])
def test_what_was_to_be_put_back_and_is_put_to_its_place_is_done_by_the_helper(kind: str) -> None:
    *_, said, close = walk(kind, "yes", "seen at place")
    assert said == Remark("Thank you. I see the pink bar at its place now.")
    assert close == Close(CloseReason.RESOLVED, Resolution.HUMAN_FINISH, True)


@pytest.mark.parametrize("kind", ["missed", "dropped", "missing", "undone"])
def test_what_was_at_its_place_before_is_no_work_of_the_helpers(kind: str) -> None:
    at_place, anywhere = (
        walk(kind, "yes", each) for each in ("seen at place, as before", "seen as before")
    )
    assert at_place == anywhere


@pytest.mark.parametrize(
    ("calls", "close"),
    [
        (["yes", "seen"], Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, True)),
        (["no", "yes", "seen"], Close(CloseReason.RESOLVED, Resolution.HUMAN_FINISH, True)),
        (["no", "no"], Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, False, failed=True)),
        (["silence"], Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False, failed=True)),
    ],
)
@pytest.mark.parametrize("kind", ["unreachable", "missing", "blocked"])
def test_after_a_brief_help_the_robot_goes_on_by_itself(
    kind: str, calls: list[str], close: Close
) -> None:
    assert walk(kind, *calls)[-1] == close


@pytest.mark.parametrize(
    ("kind", "promised"),
    [
        ("missed", Help.PUT_BACK),
        ("dropped", Help.PUT_BACK),
        ("missing", Help.PUT_BACK),
        ("unreachable", Help.HAND_OVER),
        ("blocked", Help.CLEAR_WAY),
    ],
)
def test_a_yes_is_a_promise_that_the_robot_watches_for(kind: str, promised: Help) -> None:
    assert walk(kind, "yes")[-1] == AwaitHelp(promised)
    assert walk(kind, "no", "yes")[-1] == AwaitHelp(Help.PLACE)


@pytest.mark.parametrize("kind", ["unreachable", "missing"])
def test_the_robot_goes_on_with_a_part_that_came_within_reach(kind: str) -> None:
    close = Close(CloseReason.WITHDRAWN, Resolution.ROBOT_FINISH, True)
    assert walk(kind, "in reach")[-1] == close


def test_the_robot_goes_on_when_its_way_became_clear() -> None:
    close = Close(CloseReason.WITHDRAWN, Resolution.ROBOT_FINISH, True)
    assert walk("blocked", "way clear")[-1] == close


def test_positioning_asks_and_only_a_yes_makes_it_work_of_both() -> None:
    opened = walk("positioning")
    assert shape(opened) == "Ask"
    (ask,) = opened
    assert isinstance(ask, Ask)
    assert "Thank" not in ask.text
    together = Close(CloseReason.RESOLVED, Resolution.COLLAB_FINISH, True)
    alone = Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, False)
    assert walk("positioning", "yes")[-1] == together
    assert walk("positioning", "no")[-1] == alone
    assert walk("positioning", "silence")[-1] == alone


def test_sentences_speak_of_objects_as_people_do() -> None:
    [first] = walk("dropped")
    assert isinstance(first, Ask)
    assert replace(first, ways=(), headline="") == Ask(
        text="I lost hold of the pink bar. Will you put it back on the table?",
        yes_effect="You put the pink bar back on the table, "
        "and I try again (still attempt 1 of 3).",
        no_effect="I ask whether you will place the pink bar yourself (attempt 1 of 3).",
        timeout_effect="Attempt 1 of 3 has failed, and I try again (attempt 2 of 3).",
    )


def test_a_question_says_what_the_robot_sensed() -> None:
    said = "I closed my fingers on nothing where the pink_bar was"
    (ask,) = conversation_about("missed", reason=said).open()
    assert isinstance(ask, Ask)
    assert ask.text == (
        "I missed the pink bar. I closed my fingers on nothing where the pink bar was. "
        "Will you put it back on the table?"
    )


# --- Thanks, and who has helped ----------------------------------------------------------------


def last_word(turns: list[Turn]) -> str:
    said = turns[-2]
    assert isinstance(said, Remark)
    return said.text


@pytest.mark.parametrize("kind", ["missed", "dropped", "missing", "blocked", "unreachable"])
@pytest.mark.parametrize("calls", [["yes"], ["no", "yes"]])
def test_only_a_change_that_was_seen_is_thanked_for(kind: str, calls: list[str]) -> None:
    changed, unchanged = walk(kind, *calls, "seen"), walk(kind, *calls, "seen as before")
    assert last_word(changed).startswith("Thank you. ")
    assert "thank" not in last_word(unchanged).lower()
    closes = changed[-1], unchanged[-1]
    assert [each.helped for each in closes if isinstance(each, Close)] == [True, False]


def test_of_what_was_not_seen_before_nothing_is_said_but_that_it_is_seen_now() -> None:
    turns = walk("blind", "no", "yes", "seen, not before")
    assert last_word(turns) == "I see the pink bar at its place now. I go on."
    assert turns[-1] == GOES_ON


def test_a_withdrawn_question_says_what_is_seen() -> None:
    assert last_word(walk("dropped", "at place")) == (
        "Thank you. I see the pink bar at its place now."
    )
    assert last_word(walk("dropped", "at place, nobody seen")) == (
        "I see the pink bar at its place now. I go on."
    )
    assert last_word(walk("missing", "in reach, nobody seen")) == (
        "I see the pink bar within my reach now. I go on."
    )


def test_what_was_felt_is_cleared_by_no_camera_alone() -> None:
    assert conversation_about("blocked", felt=True).open() != walk("blocked")
    conversation = conversation_about("blocked", felt=True)
    conversation.open()
    assert conversation.watched_for == ()
    with pytest.raises(ValueError, match="way_clear"):
        conversation.put_right(PutRight(Expectation.WAY_CLEAR, Change.CLEARED))


def test_the_word_of_a_helper_and_a_look_let_the_robot_go_on_once() -> None:
    calls = ("yes", "seen as before")
    assert walk("blocked", *calls, felt=True)[-1] == GOES_ON
    assert walk("blocked", *calls, felt=True, outlook=AGAIN)[-1] == FAILED_RETRY


# --- The robot's own failures ------------------------------------------------------------------


def test_a_robot_that_failed_too_often_offers_no_other_try() -> None:
    (ask,) = walk("dropped", outlook=THIRD)
    assert isinstance(ask, Ask)
    assert ask.text == (
        "I have now failed three times to hold the pink bar. Will you place the pink bar yourself?"
    )
    leave = walk("dropped", "no", outlook=THIRD)[-1]
    assert isinstance(leave, Ask)
    assert leave.text == "Shall I leave the pink bar out?"
    assert leave.no_effect == "Attempt 3 of 3 has failed, and the task ends here, unfinished."
    assert walk("dropped", "no", "yes", outlook=THIRD)[-1] == Close(
        CloseReason.LEFT_OUT, None, False
    )
    later = walk("dropped", "no", "no", outlook=THIRD)
    assert last_word(later) == "All right. The task ends here, unfinished."


def test_the_first_time_nobody_is_asked_to_leave_it_out() -> None:
    assert shape(walk("missed", "no", "no")) == "Ask Ask Remark Close"
    assert shape(walk("missed", "no", "no", outlook=AGAIN)) == "Ask Ask Ask"


@pytest.mark.parametrize(
    ("sequel", "words"),
    [
        (Sequel(), "I try again (attempt 2 of 3)"),
        (Sequel(Next.OTHERS_FIRST, ("cup",)), "I go on with the cup first, then I try again"),
        (Sequel(Next.INSTEAD, ("orange_top",)), "I take the orange top instead"),
        (Sequel(Next.EITHER, ("a", "b")), "or I take the a or the b instead"),
        (Sequel(Next.ANY_OF, ("a", "b")), "or I go on with the a or the b before that"),
        (Sequel(Next.RUN_FAILS), "the task ends here, unfinished"),
    ],
)
def test_the_last_no_says_what_follows(sequel: Sequel, words: str) -> None:
    turns = walk("missed", "no", outlook=Outlook(failed=sequel, times=2))
    leave = walk("missed", "no", "no", outlook=Outlook(failed=sequel, times=2))[-1]
    assert isinstance(leave, Ask)
    assert words in leave.no_effect
    ask = turns[-1]
    assert isinstance(ask, Ask)
    assert words in ask.timeout_effect
    last = last_word(walk("missed", "no", "no", "no", outlook=Outlook(failed=sequel, times=2)))
    assert words[1:] in last


def test_help_after_too_many_helped_tries_is_a_failed_attempt_that_says_so() -> None:
    outlook = Outlook(helped_out=True, failed=Sequel(Next.RUN_FAILS))
    turns = walk("missed", "in reach", outlook=outlook)
    assert turns[-1] == Close(CloseReason.WITHDRAWN, Resolution.ROBOT_RETRY, True, failed=True)
    assert last_word(turns).endswith("The task ends here, unfinished.")


# --- Asking again ------------------------------------------------------------------------------


def test_help_that_is_not_seen_is_asked_about_again_and_awaited_again() -> None:
    turns = walk("dropped", "no", "yes", "not seen", "yes", "seen")
    assert shape(turns) == "Ask Ask Remark AwaitHelp Ask AwaitHelp Remark Close"
    asked_again = turns[4]
    assert isinstance(asked_again, Ask)
    assert asked_again.text == (
        "I do not see the pink bar at its place yet. Are you still placing it?"
    )


def test_a_helper_who_no_longer_puts_it_back_is_asked_to_place_it() -> None:
    turns = walk("dropped", "yes", "not seen", "no")
    assert isinstance(turns[-1], Ask)
    assert turns[-1].text == "Will you place the pink bar yourself?"


def test_a_helper_who_no_longer_places_it_leaves_it_to_a_later_try() -> None:
    turns = walk("missed", "no", "yes", "not seen", "no")
    assert turns[-1] == FAILED_RETRY


def test_the_robot_gives_up_on_help_that_never_comes() -> None:
    turns = walk("missed", "yes", "not seen", "yes", "not seen", "yes", "not seen")
    assert turns[-1] == Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False, failed=True)


def test_an_illegal_call_says_what_was_expected_and_what_came() -> None:
    conversation = conversation_about("missed")
    conversation.open()
    with pytest.raises(
        IllegalTransitionError,
        match="is asking: expected answer or put_right or silence or abort, but help_seen came",
    ):
        conversation.help_seen(Change.MOVED)


def test_what_the_script_does_not_watch_for_puts_nothing_right() -> None:
    conversation = conversation_about("missed")
    conversation.open()
    with pytest.raises(ValueError, match="way_clear"):
        conversation.put_right(PutRight(Expectation.WAY_CLEAR, Change.CLEARED))
    assert conversation.phase is ConversationPhase.ASKING


def test_the_robot_watches_for_an_issue_put_right_only_while_it_asks() -> None:
    conversation = conversation_about("dropped")
    assert not conversation.watched_for
    conversation.open()
    assert conversation.watched_for == (Expectation.AT_PLACE, Expectation.IN_REACH)
    conversation.answer("yes")
    assert not conversation.watched_for
    assert conversation.phase is ConversationPhase.AWAITING_HELP


@given(
    kind=st.sampled_from(sorted(SCRIPTS)),
    outlook=st.sampled_from([FIRST, AGAIN, THIRD]),
    felt=st.booleans(),
    calls=st.lists(st.sampled_from(sorted(CALLS)), max_size=60),
)
@settings(deadline=None)
def test_whatever_comes_legal_calls_are_told_apart_and_replay_gives_the_same(
    kind: str, outlook: Outlook, felt: bool, calls: list[str]
) -> None:
    conversation = conversation_about(kind, outlook, felt=felt)
    taken: list[str] = []
    turns: list[Turn] = []
    for call in calls:
        before = (conversation.phase, conversation.watched_for)
        try:
            turns += CALLS[call](conversation)
        except (IllegalTransitionError, ValueError):
            after = (conversation.phase, conversation.watched_for)
            assert after == before
        else:
            taken.append(call)

    again = conversation_about(kind, outlook, felt=felt)
    assert [turn for call in taken for turn in CALLS[call](again)] == turns
    closes = [turn for turn in turns if isinstance(turn, Close)]
    assert len(closes) == (conversation.phase is ConversationPhase.CLOSED)


@given(
    kind=st.sampled_from(sorted(SCRIPTS)),
    outlook=st.sampled_from([FIRST, AGAIN, THIRD]),
    data=st.data(),
)
@settings(deadline=None)
def test_every_conversation_closes_within_a_bounded_number_of_asks(
    kind: str, outlook: Outlook, data: st.DataObject
) -> None:
    conversation = conversation_about(kind, outlook)
    turns = conversation.open()
    legal = {
        ConversationPhase.ASKING: ["yes", "no"],
        ConversationPhase.AWAITING_HELP: ["seen", "seen as before", "not seen", "cannot"],
        ConversationPhase.LOOKING_AGAIN: ["seen", "not yet", "not seen", "cannot"],
    }
    while conversation.phase is not ConversationPhase.CLOSED:
        calls = [*legal[conversation.phase], *(["done"] if conversation.looks_at_a_word else [])]
        call = data.draw(st.sampled_from(calls))
        turns += CALLS[call](conversation)
        # Two offers of help, each asked about twice again, and whether to leave it out.
        assert sum(isinstance(turn, Ask) for turn in turns) <= 7
    assert sum(isinstance(turn, Close) for turn in turns) == 1
    assert isinstance(turns[-1], Close)
    assert isinstance(turns[-2], Remark)
