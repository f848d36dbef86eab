"""The conversation alone: what it says, when it listens, and how it ends."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.errors import IllegalTransitionError
from mend.server.speech.commands import Command
from mend.server.speech.conversation import (
    MAX_APOLOGIES,
    PAUSE_S,
    Act,
    End,
    EndReason,
    Hear,
    SayAloud,
    Saying,
    SpokenConversation,
    StartListening,
    State,
    StopTrying,
    Understood,
)
from mend.server.speech.phrases import SORRY

QUESTION = "Shall I try again?"
HELP = "If you say yes: I try again. If you say no: I do not."


class Clock:
    """A clock that a test moves."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def conversation(clock: Clock) -> SpokenConversation:
    return SpokenConversation(QUESTION, HELP, clock)


def listen(conversation: SpokenConversation, clock: Clock) -> None:
    """Have what is being said come to its end, and the pause after it."""
    conversation.spoken()
    clock.now_s += PAUSE_S
    assert conversation.pause_over() == [StartListening()]


def say(
    conversation: SpokenConversation,
    clock: Clock,
    command: Command | None,
    phrase: str | None = None,
) -> list[Act]:
    """Have somebody say something after the robot has spoken."""
    listen(conversation, clock)
    assert conversation.speech_began() == [Hear()]
    return conversation.utterance(command, phrase, 0.3)


def test_it_begins_with_the_question(conversation: SpokenConversation) -> None:
    assert conversation.open() == [SayAloud(Saying.QUESTION, QUESTION)]


def test_nothing_is_listened_to_while_the_robot_speaks_and_a_moment_longer(
    conversation: SpokenConversation, clock: Clock
) -> None:
    conversation.open()
    assert not conversation.listens
    conversation.spoken()
    clock.now_s += PAUSE_S / 2
    assert conversation.pause_over() == []
    assert not conversation.listens
    assert conversation.pause_left_s == pytest.approx(PAUSE_S / 2)
    clock.now_s += PAUSE_S
    assert conversation.pause_over() == [StartListening()]
    assert conversation.listens
    assert conversation.pause_left_s is None


@pytest.mark.parametrize("command", [Command.YES, Command.NO, Command.STOP])
def test_yes_no_and_stop_end_it(
    conversation: SpokenConversation, clock: Clock, command: Command
) -> None:
    conversation.open()
    heard = say(conversation, clock, command, "as it was said")
    assert heard == [Understood(command, "as it was said", 0.3), End(EndReason.HEARD)]


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (Command.REPEAT, SayAloud(Saying.QUESTION, QUESTION)),
        (Command.HELP, SayAloud(Saying.HELP, HELP)),
    ],
)
def test_repeat_and_help_speak_again_and_never_count_as_failures(
    conversation: SpokenConversation, clock: Clock, command: Command, said: SayAloud
) -> None:
    conversation.open()
    for _ in range(3 * MAX_APOLOGIES):
        assert say(conversation, clock, command)[1:] == [said]
    assert say(conversation, clock, None)[1:] == [SayAloud(Saying.SORRY, SORRY)]


def test_it_apologizes_twice_and_then_gives_up(
    conversation: SpokenConversation, clock: Clock
) -> None:
    conversation.open()
    for _ in range(MAX_APOLOGIES):
        assert say(conversation, clock, None)[1:] == [SayAloud(Saying.SORRY, SORRY)]
    assert say(conversation, clock, None)[1:] == [StopTrying(), End(EndReason.GAVE_UP)]


def test_noise_without_words_is_no_utterance(
    conversation: SpokenConversation, clock: Clock
) -> None:
    conversation.open()
    for _ in range(3 * MAX_APOLOGIES):
        if conversation.state is not State.LISTENING:
            listen(conversation, clock)
        conversation.speech_began()
        assert conversation.nothing_said() == [StartListening()]


def test_an_illegal_call_says_what_was_expected_and_changes_nothing(
    conversation: SpokenConversation,
) -> None:
    with pytest.raises(IllegalTransitionError, match="is new: expected open or end, but spoken"):
        conversation.spoken()
    assert conversation.state is State.NEW
    conversation.end(EndReason.CANCELLED)
    with pytest.raises(IllegalTransitionError, match="expected nothing more"):
        conversation.end(EndReason.CANCELLED)


CALLS = st.sampled_from(
    ["open", "spoken", "pause_over", "speech_began", "yes", "repeat", "nothing", "noise", "end"]
)


@settings(deadline=None)
@given(st.lists(CALLS, max_size=60))
def test_whatever_comes_it_ends_once_and_never_listens_while_it_speaks(calls: list[str]) -> None:
    clock = Clock()
    conversation = SpokenConversation(QUESTION, HELP, clock)
    does = {
        "open": conversation.open,
        "spoken": conversation.spoken,
        "pause_over": conversation.pause_over,
        "speech_began": conversation.speech_began,
        "yes": lambda: conversation.utterance(Command.YES, "yes", 0.3),
        "repeat": lambda: conversation.utterance(Command.REPEAT, "repeat", 0.3),
        "nothing": lambda: conversation.utterance(None, None, 0.3),
        "noise": conversation.nothing_said,
        "end": lambda: conversation.end(EndReason.CANCELLED),
    }
    acts: list[Act] = []
    silent_since_s = clock.now_s
    for call in calls:
        clock.now_s += 0.1
        before = conversation.state
        try:
            done = does[call]()
        except IllegalTransitionError:
            assert conversation.state is before
            continue
        if call == "spoken":
            silent_since_s = clock.now_s
        if StartListening() in done and call == "pause_over":
            assert clock.now_s - silent_since_s >= PAUSE_S - 1e-9
        acts.extend(done)
    ends = [act for act in acts if isinstance(act, End)]
    assert len(ends) == (conversation.state is State.ENDED)
    assert not ends or acts[-1] is ends[0]
    assert sum(act == SayAloud(Saying.SORRY, SORRY) for act in acts) <= MAX_APOLOGIES
