"""The dialogue about what is not at its place: three ways out, and none that is not offered."""

import pytest

from mend.dialogue.calls import ConversationPhase
from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, Close, CloseReason, Expectation, Remark, Turn
from mend.tasks.issue import Issue, Sensed
from mend.tasks.resolution import Resolution

LAST_CHANCE = Outlook(attempt=3, attempts=3, failed=Sequel(Next.RUN_FAILS))


def about(
    *,
    interrupts: bool = True,
    outlook: Outlook | None = None,
    sensed: Sensed = Sensed.SEEN,
    reason: str = "",
) -> Conversation:
    issue = Issue(
        "undone", "pr2", "/0", "pink_bar", "pink_bar", "left", 0, reason, sensed, interrupts
    )
    return Conversation(load_scripts()["undone"], issue, outlook or Outlook())


def closing(turns: list[Turn]) -> Close:
    close = turns[-1]
    assert isinstance(close, Close)
    return close


def test_it_is_placed_again_once_it_is_brought() -> None:
    conversation = about()
    [ask] = conversation.open()
    assert isinstance(ask, Ask)
    assert ask.text == "The pink bar is not at its place. Will you put it within my reach?"
    conversation.answer("yes")
    close = closing(conversation.help_seen(Change.APPEARED))
    assert (close.resolution, close.helped) == (Resolution.ROBOT_FINISH, True)


def test_what_is_seen_elsewhere_is_told_with_what_is_wrong() -> None:
    [ask] = about(reason="pink_bar was placed, but it stands 57 mm too low").open()
    assert isinstance(ask, Ask)
    assert ask.text == (
        "The pink bar is not at its place. The pink bar was placed, but it stands 57 mm too low. "
        "Will you put it within my reach?"
    )


def test_what_is_seen_nowhere_somebody_is_asked_to_bring_back() -> None:
    conversation = about(sensed=Sensed.NOWHERE)
    [ask] = conversation.open()
    assert isinstance(ask, Ask)
    assert ask.text == (
        "The pink bar is not at its place, and I see it nowhere. Can you bring it back?"
    )
    assert ask.yes_effect == (
        "You put the pink bar on the table where I can reach it; I place it again (attempt 1 of 3)."
    )
    [asked, _] = conversation.answer("yes")
    assert asked == Remark("Please put the pink bar on the table where I can reach it.")
    close = closing(conversation.help_seen(Change.APPEARED))
    assert (close.resolution, close.helped) == (Resolution.ROBOT_FINISH, True)


def test_what_was_seen_nowhere_and_then_is_seen_the_robot_places_with_nobody_asked() -> None:
    conversation = about(sensed=Sensed.NOWHERE)
    conversation.open()
    assert conversation.denied == {Expectation.AT_PLACE, Expectation.IN_REACH}
    assert about().denied == frozenset()


def test_a_helper_may_put_it_back_at_its_place() -> None:
    conversation = about()
    conversation.open()
    conversation.answer("no")
    conversation.answer("yes")
    close = closing(conversation.help_seen(Change.APPEARED))
    assert (close.resolution, close.helped) == (Resolution.HUMAN_FINISH, True)


def test_a_helper_may_have_it_left_out() -> None:
    conversation = about(outlook=LAST_CHANCE)
    conversation.open()
    conversation.answer("no")
    [leave] = conversation.answer("no")
    assert isinstance(leave, Ask)
    assert leave.text == "Shall I leave the pink bar out?"
    close = closing(conversation.answer("yes"))
    assert (close.reason, close.resolution) == (CloseReason.LEFT_OUT, None)


@pytest.mark.parametrize("sensed", [Sensed.SEEN, Sensed.NOWHERE])
@pytest.mark.parametrize(
    ("times", "resolution"), [(1, Resolution.ROBOT_FINISH), (2, Resolution.ROBOT_RETRY)]
)
def test_where_nothing_has_changed_it_goes_on_once_and_then_the_attempt_has_failed(
    times: int, resolution: Resolution, sensed: Sensed
) -> None:
    conversation = about(outlook=Outlook(times=times, unchanged=times), sensed=sensed)
    conversation.open()
    conversation.answer("yes")
    remark, close = conversation.help_seen(Change.NONE)
    assert isinstance(remark, Remark)
    assert isinstance(close, Close)
    goes_on = resolution is Resolution.ROBOT_FINISH
    assert remark.text.endswith("I go on." if goes_on else "I try again (attempt 2 of 3).")
    assert "Thank you" not in remark.text
    assert (close.resolution, close.helped, close.failed) == (resolution, False, not goes_on)


@pytest.mark.parametrize("outlook", [Outlook(), LAST_CHANCE])
def test_where_the_robot_goes_on_by_itself_it_only_says_so(outlook: Outlook) -> None:
    conversation = about(interrupts=False, outlook=outlook)
    said, close = conversation.open()
    assert isinstance(said, Remark)
    assert said.text.startswith("The pink bar is not at its place. I place it again.")
    assert isinstance(close, Close)
    assert (close.resolution, close.helped) == (Resolution.ROBOT_FINISH, False)
    assert conversation.phase is ConversationPhase.CLOSED
