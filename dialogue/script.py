"""What a dialogue script is made of, and what a conversation tells its surroundings to do.

A script is a table of states; `dialogue.conversation` walks it. Nothing here knows sockets,
deadlines or a clock.
"""

from dataclasses import dataclass
from enum import StrEnum

from tasks.resolution import Resolution


class Help(StrEnum):
    """The physical help that a helper can promise; a camera has to see it before it counts."""

    PLACE = "place"
    """Put the object to its final place."""
    PUT_BACK = "put_back"
    """Put the object back on the table, within the robot's reach."""
    HAND_OVER = "hand_over"
    """Hand the object to the robot."""
    CLEAR_WAY = "clear_way"
    """Get what blocks the arm out of its way."""


class CloseReason(StrEnum):
    """Why a dialogue ended."""

    RESOLVED = "resolved"
    WITHDRAWN = "withdrawn"
    """The robot saw it put right before anyone answered."""
    GAVE_UP = "gave_up"
    """Nobody answered, or the promised help was never seen."""
    ABORTED = "aborted"
    """The run ended."""


@dataclass(frozen=True, slots=True)
class Ask:
    """A yes/no question; the effects say in plain words what each answer will do."""

    text: str
    yes_effect: str
    no_effect: str


@dataclass(frozen=True, slots=True)
class Say:
    """A statement; nobody answers it."""

    text: str


@dataclass(frozen=True, slots=True)
class AwaitHelp:
    """Watch for promised help; the conversation is told whether it was seen."""

    help: Help


@dataclass(frozen=True, slots=True)
class Close:
    """The dialogue is over. `helped`: help was verified, so this is no failed attempt."""

    reason: CloseReason
    resolution: Resolution | None
    helped: bool


Turn = Ask | Say | AwaitHelp | Close
