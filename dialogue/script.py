"""What a dialogue script is made of, and what a conversation tells its surroundings to do.

A script is a table of states; `dialogue.conversation` walks it. Nothing here knows sockets,
deadlines or a clock.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Generic, Literal, TypeVar

from pydantic import BaseModel

from mend.tasks.issue import Sensed
from mend.tasks.resolution import Resolution


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
    CLEAR_VIEW = "clear_view"
    """Get what hides the table from the head camera out of its view."""
    TELL_PLACE = "tell_place"
    """Nothing to be done: tell the robot where it is. What it sees there has to agree."""
    PUT_IN = "put_in"
    """Put something into the robot's basket."""
    TAKE_OUT = "take_out"
    """Take something out of the robot's basket."""
    CHARGE = "charge"
    """Plug the robot in."""
    SEND_PERSON = "send_person"
    """Have whom the robot escorts come to it."""


class Felt(StrEnum):
    """What a robot feels in its basket, or is handed, while what it needs there is not so.

    A load cell tells how much, and never what.
    """

    NOTHING = "nothing"
    """As much as before."""
    TOO_LITTLE = "too_little"
    """A little more than before, too little to be anything that was asked for."""
    TOO_MUCH = "too_much"
    """More than the basket may hold."""
    LIGHTER = "lighter"
    """Less than before, where more was asked for."""
    HEAVIER = "heavier"
    """More than before, where less was asked for."""
    ANOTHER = "another"
    """Less than before, but not by as much as what was asked for weighed; of what was to be handed
    over: something that does not look like it."""


class Sight(StrEnum):
    """What a look saw of the object that was to be somewhere, and was not."""

    NOWHERE = "nowhere"
    UNMOVED = "unmoved"
    """Where the first look saw it."""
    ELSEWHERE = "elsewhere"
    """Neither there nor where it was to be."""


class CloseReason(StrEnum):
    """Why a dialogue ended."""

    RESOLVED = "resolved"
    WITHDRAWN = "withdrawn"
    """The robot saw it put right, or saw that it was wrong, before anyone answered."""
    GAVE_UP = "gave_up"
    """Nobody answered, or the promised help was never seen."""
    LEFT_OUT = "left_out"
    """A helper said that the leaf is to be left out."""
    ABORTED = "aborted"
    """The run ended."""


Answer = Literal["yes", "no"]


@dataclass(frozen=True, slots=True)
class Way:
    """One way to answer a question and those that its answers lead to, all at once.

    `name` is that of the state it leads to, `deed` what the helper then does, and `label` the same
    below the headline, which may have named the object. `answers` are those that lead there, one
    after the other; without any yes nobody helps. `effect` and `final` are those of the last.
    """

    name: str
    deed: str
    label: str
    effect: str
    answers: tuple[Answer, ...]
    final: bool = False


@dataclass(frozen=True, slots=True)
class Ask:
    """A yes/no question; the effects say in plain words what each answer, and silence, will do.

    An answer is final when nothing that is asked later can take it back. `ways` are all that could
    be answered to it and to what follows a no, the first first, and `headline` what is asked of the
    helper in few words; both are empty where a script has no `deed` for one of them.
    """

    text: str
    yes_effect: str
    no_effect: str
    timeout_effect: str
    yes_final: bool = False
    no_final: bool = False
    ways: tuple[Way, ...] = ()
    headline: str = ""


@dataclass(frozen=True, slots=True)
class Remark:
    """A statement; nobody answers it."""

    text: str


@dataclass(frozen=True, slots=True)
class AwaitHelp:
    """Watch for promised help; the conversation is told whether it was seen.

    `guess`: where a person has said that the robot is.
    """

    help: Help
    guess: str | None = None


@dataclass(frozen=True, slots=True)
class Close:
    """The dialogue is over. `helped`: a person was seen to help, or heard to where both work.

    `failed`: the leaf, which is put back, has failed once more.
    """

    reason: CloseReason
    resolution: Resolution | None
    helped: bool
    failed: bool = False


Turn = Ask | Remark | AwaitHelp | Close


class Expectation(StrEnum):
    """What a robot can see by itself that puts an issue right, with nobody having answered."""

    AT_PLACE = "at_place"
    """The object rests at its final place."""
    IN_REACH = "in_reach"
    """The object rests within the robot's reach."""
    IN_GRIPPER = "in_gripper"
    """The object is between the robot's fingers."""
    WAY_CLEAR = "way_clear"
    """Nothing is in the arm's way."""
    LED_ROUND = "led_round"
    """Another way leads round what is in the way of a base."""
    VIEW_CLEAR = "view_clear"
    """The head camera shows the table."""
    LOCATED = "located"
    """The robot knows where it is."""
    LOADED = "loaded"
    """The robot feels in its basket what it was to be given, or to be given back."""
    UNLOADED = "unloaded"
    """The robot feels that its basket is lighter by what was to be taken out."""
    CHARGED = "charged"
    """The robot feels that its battery is being charged."""
    ACCOMPANIED = "accompanied"
    """The robot sees near it whom it escorts."""


EXPECTED: Mapping[Help, Expectation] = {
    Help.PLACE: Expectation.AT_PLACE,
    Help.PUT_BACK: Expectation.IN_REACH,
    Help.HAND_OVER: Expectation.IN_GRIPPER,
    Help.CLEAR_WAY: Expectation.WAY_CLEAR,
    Help.CLEAR_VIEW: Expectation.VIEW_CLEAR,
    Help.TELL_PLACE: Expectation.LOCATED,
    Help.PUT_IN: Expectation.LOADED,
    Help.TAKE_OUT: Expectation.UNLOADED,
    Help.CHARGE: Expectation.CHARGED,
    Help.SEND_PERSON: Expectation.ACCOMPANIED,
}
"""What a robot has to see before a promise counts as kept."""


ATTEMPT_FAILED = "{attempt} has failed, and {later}."
"""What an answer, or silence, does that leaves the leaf to a later try."""


@dataclass(frozen=True, slots=True)
class AskState:
    """Asks; `yes`, `no` and `unanswered` name the states that follow.

    Silence gives up unless `unanswered` says otherwise. A question that is only put `if_refused`
    before (`Outlook.may_be_left`) is passed over the first time, as if the answer were no, and so
    is one about a `guess` (counted from 1) where the robot has not as many.
    `headline` is said in place of the deed that a yes leads to, where that is not what is asked.
    Every text of a table may hold the fields of `dialogue.wording`.
    """

    text: str
    yes: str
    yes_effect: str
    no: str
    no_effect: str
    unanswered: str | None = None
    unanswered_effect: str = ATTEMPT_FAILED
    if_refused: bool = False
    guess: int = 0
    headline: str = ""


@dataclass(frozen=True, slots=True)
class HelpState:
    """Says what to do, watches for that help, and closes with `resolution` once it is seen.

    `thanks` is said if something was seen to change that only a person can have changed, and
    `unchanged` if it is as promised but was so before; what the robot does next is added to both.
    While it is not seen, `not_seen` says so and then asks whether it still comes, or `not_felt`
    where the robot feels something else; `otherwise` names the state that follows a no, and
    `otherwise_effect` says what that will do. `given_up` is said once it has been asked about often
    enough. `deed` says in few words what the helper does (`Put {it} back`), and `deeds_felt` what
    they do about what the robot feels instead. `goes_on` says, as a clause, what the robot does
    next that need not try again.
    """

    text: str
    help: Help
    resolution: Resolution
    thanks: str
    unchanged: str
    not_seen: str
    otherwise: str
    otherwise_effect: str
    not_felt: Mapping[Felt, str] = field(default_factory=dict)
    given_up: str = "I still do not see that help."
    deed: str = ""
    deeds_felt: Mapping[Felt, str] = field(default_factory=dict)
    goes_on: str = "I go on"


@dataclass(frozen=True, slots=True)
class ToldState:
    """A person has said yes to a `guess`: the robot sees whether that agrees with what it sees.

    If so it says `thanks` and closes with `resolution`; else it says `doubted`, and `otherwise`
    names the state that follows. `deed` is what a helper says.
    """

    guess: int
    resolution: Resolution
    thanks: str
    doubted: str
    otherwise: str
    deed: str = ""


@dataclass(frozen=True, slots=True)
class CloseState:
    """Says a last word and closes.

    A `robot_retry` reached this way is a failed attempt, and the last word ends with what comes
    next. `collab_finish`, and `robot_finish` where a word is all that is wanted, count as help only
    after a yes. `deed` is what a helper does who says yes; a no that leads here needs none.
    """

    text: str
    resolution: Resolution
    deed: str = ""


@dataclass(frozen=True, slots=True)
class LeaveState:
    """Says a last word and closes: a helper wants the leaf left out, by that `deed`."""

    text: str
    deed: str = ""


State = AskState | HelpState | ToldState | CloseState | LeaveState


@dataclass(frozen=True, slots=True)
class Script:
    """The table of one kind of issue.

    `opening` names the first state, `failed_opening` the one that takes its place once the robot
    has failed at this so often that another try is not worth offering, `on_the_way` the one where
    the robot goes on by itself, so that there is nothing to ask. `put_right` says what the
    robot may see happen before anyone answers, the most telling first, and how the issue is then
    resolved; `denied` what of it the issue itself says not to be so. `reasks` is how often promised
    help that is not seen is asked about again. `may_be_mistaken`: the robot did not see the issue
    but judged it, so that the same again, where its looks see nothing wrong and nothing changed,
    is a suspected false alarm. `variants` are the scripts that take its place for what was sensed
    otherwise than by seeing it, and `without_object` the one for a leaf that handles nothing.
    """

    opening: str
    states: Mapping[str, State]
    put_right: Mapping[Expectation, Resolution] = field(default_factory=dict)
    reasks: int = 2
    failed_opening: str | None = None
    on_the_way: str | None = None
    denied: frozenset[Expectation] = frozenset()
    may_be_mistaken: bool = False
    variants: Mapping[Sensed, "Script"] = field(default_factory=dict)
    without_object: "Script | None" = None

    @property
    def openings(self) -> tuple[str, ...]:
        """Every state that a conversation may begin with."""
        others = (self.failed_opening, self.on_the_way)
        return (self.opening, *(each for each in others if each is not None))


Parameters = TypeVar("Parameters", bound=BaseModel)


@dataclass(frozen=True, slots=True)
class ScriptWithParameters(Generic[Parameters]):
    """A script that can be adjusted: the model of its parameters, and what makes the table."""

    parameters: type[Parameters]
    make: Callable[[Parameters], Script]
