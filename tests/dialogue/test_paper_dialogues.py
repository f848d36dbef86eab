"""The dialogues of the paper's Section 4.1, walked with its scenario's answers."""

from collections.abc import Iterator

from mend.dialogue.calls import ConversationPhase
from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change
from mend.dialogue.outlook import Outlook
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Close
from mend.tasks.issue import Issue
from mend.tasks.resolution import Resolution
from mend.tasks.scenario_file import built_in_scenario

ISSUES = [
    ("dropped", "pink_bar"),
    ("dropped", "yellow_bar"),
    ("positioning", "yellow_bar"),
    ("missed", "blue_leg"),
    ("positioning", "blue_leg"),
    ("unreachable", "purple_top"),
]


def resolution_of(kind: str, handled: str, answers: Iterator[str]) -> Resolution | None:
    """How the dialogue ends when help is seen as soon as it is promised."""
    issue = Issue(kind, "pr2", "/0", handled, handled, None, 5)
    conversation = Conversation(load_scripts()[kind], issue, Outlook())
    turns = conversation.open()
    while conversation.phase is not ConversationPhase.CLOSED:
        if conversation.phase is ConversationPhase.AWAITING_HELP:
            turns += conversation.help_seen(Change.APPEARED)
        else:
            turns += conversation.answer("yes" if next(answers) == "yes" else "no")
    close = turns[-1]
    assert isinstance(close, Close)
    return close.resolution


def test_the_papers_answers_lead_to_the_papers_resolutions_and_none_is_left_over() -> None:
    answers = iter(built_in_scenario("eket_paper").answers)
    assert [resolution_of(kind, handled, answers) for kind, handled in ISSUES] == [
        Resolution.HUMAN_FINISH,
        Resolution.ROBOT_RETRY,
        Resolution.COLLAB_FINISH,
        Resolution.ROBOT_RETRY,
        Resolution.COLLAB_FINISH,
        Resolution.ROBOT_FINISH,
    ]
    assert list(answers) == []
