"""What a dialogue script is made of, and what a conversation tells its surroundings to do.

A script is a table of states; `dialogue.conversation` walks it. Nothing here knows sockets,
deadlines or a clock.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Generic, TypeVar

from pydantic import BaseModel

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
    """A yes/no question; the effects say in plain words what each answer will do.

    An answer is final when nothing that is asked later can take it back.
    """

    text: str
    yes_effect: str
    no_effect: str
    yes_final: bool = False
    no_final: bool = False


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


class Expectation(StrEnum):
    """What a robot can see by itself that puts an issue right, with nobody having answered."""

    AT_PLACE = "at_place"
    """The object rests at its final place."""
    IN_REACH = "in_reach"
    """The object rests within the robot's reach."""
    WAY_CLEAR = "way_clear"
    """Nothing is in the arm's way."""


@dataclass(frozen=True, slots=True)
class AskState:
    """Asks; `yes` and `no` name the states that follow.

    Every text of a table may hold `{object}`, `{place}`, `{name}` (of the leaf) and `{robot}`.
    """

    text: str
    yes: str
    yes_effect: str
    no: str
    no_effect: str


@dataclass(frozen=True, slots=True)
class HelpState:
    """Says what to do, watches for that help, and closes with `resolution` once it is seen.

    While it is not seen, `not_seen` asks whether it still comes; `otherwise` names the state that
    follows a no, and `otherwise_effect` says what that will do.
    """

    text: str
    help: Help
    resolution: Resolution
    thanks: str
    not_seen: str
    otherwise: str
    otherwise_effect: str


@dataclass(frozen=True, slots=True)
class CloseState:
    """Says a last word and closes. A `robot_retry` reached this way is a failed attempt."""

    text: str
    resolution: Resolution


State = AskState | HelpState | CloseState


@dataclass(frozen=True, slots=True)
class Script:
    """The table of one kind of issue.

    `put_right` says what the robot may see happen before anyone answers, the most telling first,
    and how the issue is then resolved. `reasks` is how often promised help that is not seen is
    asked about again. `on_the_way` is the state that it begins with instead where the robot goes on
    by itself, so that there is nothing to ask.
    """

    opening: str
    states: Mapping[str, State]
    put_right: Mapping[Expectation, Resolution] = field(default_factory=dict)
    reasks: int = 2
    on_the_way: str | None = None


Parameters = TypeVar("Parameters", bound=BaseModel)


@dataclass(frozen=True, slots=True)
class ScriptWithParameters(Generic[Parameters]):
    """A script that can be adjusted: the model of its parameters, and what makes the table."""

    parameters: type[Parameters]
    make: Callable[[Parameters], Script]
