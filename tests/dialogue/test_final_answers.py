"""Whether an answer can be taken back follows from the script: what it leads to."""

import pytest

from mend.dialogue.conversation import Conversation
from mend.dialogue.outlook import Outlook
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, AskState, CloseState, Help, HelpState, Script
from mend.tasks.issue import Issue
from mend.tasks.resolution import Resolution

ISSUE = Issue("odd", "pr2", "/0", "cup", "cup", None, 1)


def the_ask(turns: object) -> Ask:
    assert isinstance(turns, list)
    (ask,) = [each for each in turns if isinstance(each, Ask)]
    return ask


def help_state(resolution: Resolution) -> HelpState:
    return HelpState(
        text="Please.",
        help=Help.PLACE,
        resolution=resolution,
        thanks="Thanks.",
        unchanged="There it is.",
        not_seen="Still?",
        otherwise="later",
        otherwise_effect="Later.",
    )


LATER = CloseState(text="Later.", resolution=Resolution.ROBOT_RETRY)
QUESTION = AskState(text="And?", yes="later", yes_effect="", no="later", no_effect="")


@pytest.mark.parametrize(
    ("following", "final"),
    [
        (QUESTION, False),
        (LATER, True),
        (CloseState(text="Slowly.", resolution=Resolution.COLLAB_FINISH), True),
        (help_state(Resolution.HUMAN_FINISH), False),
        (help_state(Resolution.ROBOT_RETRY), False),
        (help_state(Resolution.ROBOT_FINISH), True),
        (help_state(Resolution.COLLAB_FINISH), True),
    ],
)
@pytest.mark.parametrize("answer", ["yes", "no"])
def test_what_closes_the_dialogue_or_moves_the_robot_is_final(
    following: AskState | HelpState | CloseState, final: bool, answer: str
) -> None:
    ways = {"yes": "other", "no": "other", answer: "following"}
    opening = AskState(text="Well?", yes=ways["yes"], yes_effect="", no=ways["no"], no_effect="")
    states = {"opening": opening, "following": following, "other": QUESTION, "later": LATER}
    ask = the_ask(Conversation(Script(opening="opening", states=states), ISSUE, Outlook()).open())
    other = "no" if answer == "yes" else "yes"
    finals = {"yes": ask.yes_final, "no": ask.no_final}
    assert finals == {answer: final, other: False}


@pytest.mark.parametrize(
    ("kind", "yes_final"),
    [
        ("missed", False),
        ("dropped", False),
        ("unreachable", True),
        ("missing", True),
        ("blocked", True),
    ],
)
def test_first_questions_of_the_scripts(kind: str, yes_final: bool) -> None:
    ask = the_ask(Conversation(load_scripts()[kind], ISSUE, Outlook()).open())
    assert (ask.yes_final, ask.no_final) == (yes_final, False)


def test_refusing_a_promise_that_was_not_kept_is_final_if_nothing_is_asked_after_it() -> None:
    conversation = Conversation(load_scripts()["missed"], ISSUE, Outlook())
    conversation.open()
    conversation.answer("no")
    conversation.answer("yes")
    ask = the_ask(conversation.help_not_seen())
    assert (ask.yes_final, ask.no_final) == (False, True)
