"""A question about what is in the way is withdrawn, thanking nobody, where another way leads."""

import pytest

from mend.dialogue import blocked, door_closed, elevator_help
from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change, LookOutcome, PutRight, contradiction, put_right
from mend.dialogue.outlook import Outlook
from mend.dialogue.place_branch import Patience
from mend.dialogue.script import Ask, Close, CloseReason, Expectation, Remark
from mend.tasks.issue import Issue, Sensed
from mend.tasks.resolution import Resolution

SCRIPTS = {
    "blocked": blocked.script,
    "door_closed": door_closed.script,
    "elevator_help": elevator_help.script,
}
SAID = Remark("Another way leads round. I take it.")
NOTHING = LookOutcome(frozenset(), None)
ROUND = LookOutcome(frozenset({Expectation.LED_ROUND}), None)


def begun(kind: str, outlook: Outlook | None = None) -> Conversation:
    issue = Issue(
        kind=kind,
        robot="ada",
        node="/0",
        name="go to 101",
        object=None,
        place="F1-101",
        step=1,
        interrupts=True,
        sensed=Sensed.BY_LASER,
    )
    conversation = Conversation(SCRIPTS[kind].make(Patience()), issue, outlook or Outlook())
    conversation.open()
    return conversation


@pytest.mark.parametrize("kind", SCRIPTS)
@pytest.mark.parametrize("unchanged", [1, 2, 3])
def test_it_is_withdrawn_and_the_robot_goes_on(kind: str, unchanged: int) -> None:
    conversation = begun(kind, Outlook(times=unchanged, unchanged=unchanged))
    seen = put_right(conversation.watched_for, NOTHING, ROUND)
    assert seen == PutRight(Expectation.LED_ROUND, Change.LED_ROUND)
    close = Close(CloseReason.WITHDRAWN, Resolution.ROBOT_FINISH, helped=False)
    assert conversation.put_right(seen) == [SAID, close]


@pytest.mark.parametrize("kind", SCRIPTS)
def test_nobody_is_thanked_who_has_promised_to_clear_the_way(kind: str) -> None:
    conversation = begun(kind)
    conversation.answer("yes")
    close = Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, helped=False)
    assert conversation.help_seen(Change.LED_ROUND) == [SAID, close]


def test_it_may_be_so_at_the_first_look_already() -> None:
    conversation = begun("blocked")
    seen = contradiction(conversation.watched_for, conversation.denied, ROUND)
    assert seen == PutRight(Expectation.LED_ROUND, Change.LED_ROUND)


def test_what_an_arm_saw_in_its_way_has_no_other_way() -> None:
    script = blocked.script.make(Patience())
    assert Expectation.LED_ROUND not in script.put_right
    assert Expectation.LED_ROUND in script.variants[Sensed.BY_LASER].put_right


def test_a_robot_that_has_failed_is_asked_to_be_pushed_aside_by_its_name() -> None:
    issue = Issue(
        kind="blocked",
        robot="ada",
        node="/0",
        name="go to 101",
        object=None,
        place="F1-101",
        step=1,
        reason="robot_2 has failed, and has stood 0.3 m in front of me for 5 s; "
        "it may be pushed aside",
        sensed=Sensed.BY_LASER,
    )
    conversation = Conversation(SCRIPTS["blocked"].make(Patience()), issue, Outlook())
    (ask,) = [each for each in conversation.open() if isinstance(each, Ask)]
    assert ask.text == (
        "I cannot go on. Robot 2 has failed, and has stood 0.3 m in front of me for 5 s; it may be "
        "pushed aside. Can you clear the way?"
    )
