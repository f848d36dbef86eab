"""A conversation walks a sound script and closes exactly once, whatever it is told."""

from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dialogue.conversation import Conversation, IllegalTransitionError, Phase
from dialogue.registry import load_scripts
from dialogue.script import (
    Ask,
    AwaitHelp,
    Close,
    CloseReason,
    Expectation,
    Help,
    Say,
    Turn,
)
from tasks.issue import Issue
from tasks.resolution import Resolution

SCRIPTS = load_scripts()

Call = Callable[[Conversation], list[Turn]]

CALLS: dict[str, Call] = {
    "open": Conversation.open,
    "yes": lambda conversation: conversation.answer("yes"),
    "no": lambda conversation: conversation.answer("no"),
    "seen": Conversation.help_seen,
    "not seen": Conversation.help_not_seen,
    "at place": lambda conversation: conversation.put_right(Expectation.AT_PLACE),
    "in reach": lambda conversation: conversation.put_right(Expectation.IN_REACH),
    "way clear": lambda conversation: conversation.put_right(Expectation.WAY_CLEAR),
    "silence": Conversation.silence,
    "abort": Conversation.abort,
}


def conversation_about(kind: str) -> Conversation:
    issue = Issue(
        kind=kind,
        robot="pr2",
        node="/1/0",
        name="place_pink_bar",
        object="pink_bar",
        place="pink_bar_place",
        step=5,
    )
    return Conversation(SCRIPTS[kind], issue)


def walk(kind: str, *calls: str) -> list[Turn]:
    """All turns of a conversation that is opened and told these things."""
    conversation = conversation_about(kind)
    turns = conversation.open()
    for call in calls:
        turns += CALLS[call](conversation)
    return turns


def shape(turns: list[Turn]) -> str:
    """The kinds of turns in order, as in 'Ask Say AwaitHelp'."""
    return " ".join(type(turn).__name__ for turn in turns)


@pytest.mark.parametrize("kind", ["missed", "dropped"])
@pytest.mark.parametrize(
    ("calls", "close"),
    [
        (["yes", "seen"], Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, True)),
        (["no", "yes", "seen"], Close(CloseReason.RESOLVED, Resolution.HUMAN_FINISH, True)),
        (["no", "no"], Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, False)),
        (["at place"], Close(CloseReason.WITHDRAWN, Resolution.HUMAN_FINISH, True)),
        (["in reach"], Close(CloseReason.WITHDRAWN, Resolution.ROBOT_RETRY, True)),
        (["silence"], Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False)),
        (["no", "silence"], Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False)),
        (["abort"], Close(CloseReason.ABORTED, None, False)),
    ],
)
def test_a_lost_part_is_put_back_or_placed_by_the_helper_or_tried_again_later(
    kind: str, calls: list[str], close: Close
) -> None:
    assert walk(kind, *calls)[-1] == close


@pytest.mark.parametrize(
    ("calls", "close"),
    [
        (["yes", "seen"], Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, True)),
        (["no", "yes", "seen"], Close(CloseReason.RESOLVED, Resolution.HUMAN_FINISH, True)),
        (["no", "no"], Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, False)),
        (["silence"], Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False)),
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


def test_positioning_says_one_sentence_and_needs_no_answer() -> None:
    turns = walk("positioning")
    assert shape(turns) == "Say Close"
    assert turns[-1] == Close(CloseReason.RESOLVED, Resolution.COLLAB_FINISH, True)


def test_sentences_speak_of_objects_as_people_do() -> None:
    first = walk("dropped")[0]
    assert first == Ask(
        text="I dropped the pink bar. Shall I try again?",
        yes_effect="You put the pink bar back on the table; I pick it up later.",
        no_effect="I ask whether you will place the pink bar yourself.",
    )


def test_help_that_is_not_seen_is_asked_about_again_and_awaited_again() -> None:
    turns = walk("dropped", "no", "yes", "not seen", "yes", "seen")
    assert shape(turns) == "Ask Ask Say AwaitHelp Ask AwaitHelp Say Close"
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
    assert turns[-1] == Close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, False)


def test_the_robot_gives_up_on_help_that_never_comes() -> None:
    turns = walk("missed", "yes", "not seen", "yes", "not seen", "yes", "not seen")
    assert turns[-1] == Close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, False)


def test_an_illegal_call_says_what_was_expected_and_what_came() -> None:
    conversation = conversation_about("missed")
    conversation.open()
    with pytest.raises(
        IllegalTransitionError,
        match="is asking: expected answer or put_right or silence or abort, but help_seen came",
    ):
        conversation.help_seen()


def test_what_the_script_does_not_watch_for_puts_nothing_right() -> None:
    conversation = conversation_about("missed")
    conversation.open()
    with pytest.raises(ValueError, match="way_clear"):
        conversation.put_right(Expectation.WAY_CLEAR)
    assert conversation.phase is Phase.ASKING


def test_the_robot_watches_for_an_issue_put_right_only_while_it_asks() -> None:
    conversation = conversation_about("dropped")
    assert not conversation.watched_for
    conversation.open()
    assert conversation.watched_for == (Expectation.AT_PLACE, Expectation.IN_REACH)
    conversation.answer("yes")
    assert not conversation.watched_for
    assert conversation.awaited_help is Help.PUT_BACK


@given(
    kind=st.sampled_from(sorted(SCRIPTS)),
    calls=st.lists(st.sampled_from(sorted(CALLS)), max_size=60),
)
@settings(deadline=None)
def test_whatever_comes_legal_calls_are_told_apart_and_replay_gives_the_same(
    kind: str, calls: list[str]
) -> None:
    conversation = conversation_about(kind)
    taken: list[str] = []
    turns: list[Turn] = []
    for call in calls:
        before = (conversation.phase, conversation.awaited_help, conversation.watched_for)
        try:
            turns += CALLS[call](conversation)
        except (IllegalTransitionError, ValueError):
            after = (conversation.phase, conversation.awaited_help, conversation.watched_for)
            assert after == before
        else:
            taken.append(call)

    again = conversation_about(kind)
    assert [turn for call in taken for turn in CALLS[call](again)] == turns
    closes = [turn for turn in turns if isinstance(turn, Close)]
    assert len(closes) == (conversation.phase is Phase.CLOSED)


@given(kind=st.sampled_from(sorted(SCRIPTS)), data=st.data())
@settings(deadline=None)
def test_every_conversation_closes_within_a_bounded_number_of_asks(
    kind: str, data: st.DataObject
) -> None:
    conversation = conversation_about(kind)
    turns = conversation.open()
    legal = {
        Phase.ASKING: ["yes", "no"],
        Phase.AWAITING_HELP: ["seen", "not seen"],
    }
    while conversation.phase is not Phase.CLOSED:
        call = data.draw(st.sampled_from(legal[conversation.phase]))
        turns += CALLS[call](conversation)
        # Two offers of help, each asked about twice again.
        assert sum(isinstance(turn, Ask) for turn in turns) <= 6
    assert sum(isinstance(turn, Close) for turn in turns) == 1
    assert isinstance(turns[-1], Close)
    assert isinstance(turns[-2], Say)
