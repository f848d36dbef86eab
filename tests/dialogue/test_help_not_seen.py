"""Help that was not seen in time: it is asked about, or given up, and darkness is told as that."""

from mend.dialogue.conversation import Conversation
from mend.dialogue.outlook import Outlook
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, Close, CloseReason, Remark, Turn
from mend.tasks.issue import Issue
from mend.tasks.resolution import Resolution

ISSUE = Issue("dropped", "pr2", "/0", "cup", "cup", None, 1)
BLACK = "the picture of my head camera is black"


def promised(outlook: Outlook) -> Conversation:
    """A conversation in which somebody has said that they put the cup back."""
    conversation = Conversation(load_scripts()["dropped"], ISSUE, outlook)
    conversation.open()
    conversation.answer("yes")
    return conversation


def yes_effects(conversation: Conversation) -> list[str]:
    """What a yes does each time that it is asked whether the help still comes."""
    effects: list[str] = []
    while True:
        turns = conversation.help_not_seen()
        asks = [each for each in turns if isinstance(each, Ask)]
        if not asks:
            return effects
        effects.append(asks[0].yes_effect)
        conversation.answer("yes")


def test_the_last_yes_says_that_the_attempt_may_fail_and_no_earlier_one_does() -> None:
    *earlier, last = yes_effects(promised(Outlook()))
    assert last.startswith("I keep watching for it (attempt 1 of 3); if I do not see it then, ")
    assert "attempt 1 of 3 has failed" in last
    assert all("failed" not in each for each in earlier)


def closed_in_the_dark(outlook: Outlook) -> tuple[str, Close]:
    turns: list[Turn] = promised(outlook).help_not_seen(blind=BLACK)
    remark, close = turns
    assert isinstance(remark, Remark)
    assert isinstance(close, Close)
    return remark.text, close


def test_who_could_see_nothing_says_so_and_has_not_failed() -> None:
    said, close = closed_in_the_dark(Outlook())
    assert said == (
        "The picture of my head camera is black. I cannot see whether anybody has helped. "
        "I look again before I go on."
    )
    assert (close.reason, close.resolution) == (CloseReason.GAVE_UP, Resolution.ROBOT_RETRY)
    assert not close.failed
    assert not close.helped


def test_darkness_that_comes_again_is_a_failed_attempt() -> None:
    said, close = closed_in_the_dark(Outlook(times=2, unchanged=2))
    assert "I cannot see whether anybody has helped." in said
    assert close.failed
