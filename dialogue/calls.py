"""What comes to a conversation, and in which phase it takes what."""

from enum import StrEnum

from mend.tasks.transitions import Transitions


class ConversationPhase(StrEnum):
    """Where a conversation is, and so which calls it takes."""

    NEW = "new"
    ASKING = "asking"
    AWAITING_HELP = "awaiting help"
    LOOKING_AGAIN = "looking again"
    """It awaits help that somebody has said to be done: the next look tells them what it saw."""
    CLOSED = "closed"


class DialogueCall(StrEnum):
    """What comes to a conversation."""

    OPEN = "open"
    ANSWER = "answer"
    PUT_RIGHT = "put_right"
    SILENCE = "silence"
    HELP_SEEN = "help_seen"
    HELP_NOT_SEEN = "help_not_seen"
    SAID_DONE = "said_done"
    NOT_SEEN_YET = "not_seen_yet"
    TAKE_BACK = "take_back"
    ABORT = "abort"


_AWAITING = (
    DialogueCall.HELP_SEEN,
    DialogueCall.HELP_NOT_SEEN,
    DialogueCall.TAKE_BACK,
    DialogueCall.ABORT,
)

CALLS = Transitions(
    "the conversation",
    {
        ConversationPhase.NEW: (DialogueCall.OPEN, DialogueCall.ABORT),
        ConversationPhase.ASKING: (
            DialogueCall.ANSWER,
            DialogueCall.PUT_RIGHT,
            DialogueCall.SILENCE,
            DialogueCall.ABORT,
        ),
        ConversationPhase.AWAITING_HELP: (*_AWAITING, DialogueCall.SAID_DONE),
        ConversationPhase.LOOKING_AGAIN: (*_AWAITING, DialogueCall.NOT_SEEN_YET),
        ConversationPhase.CLOSED: (),
    },
)
