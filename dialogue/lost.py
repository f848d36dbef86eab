"""The script for `lost`: ask where the robot is, and believe that as far as the laser agrees."""

from mend.dialogue.script import (
    ATTEMPT_FAILED,
    AskState,
    CloseState,
    Expectation,
    LeaveState,
    Script,
    State,
    ToldState,
)
from mend.tasks.resolution import Resolution

_GUESSES = 3


def _question(number: int) -> AskState:
    began = "I do not know where I am.{why} " if number == 1 else ""
    return AskState(
        text=f"{began}Am I {{guess_{number}}}?",
        yes=f"told_{number}",
        yes_effect="I look whether what I see agrees; if so, {go_on}.",
        no=_after(number),
        no_effect="I ask about another place, or else whether I shall leave {doing} out.",
        guess=number,
        headline="say where I am",
    )


def _told(number: int) -> ToldState:
    return ToldState(
        guess=number,
        resolution=Resolution.ROBOT_FINISH,
        thanks=f"Thank you. What I see agrees: I am {{guess_{number}}}.",
        doubted=f"What I see does not agree with my being {{guess_{number}}}.",
        otherwise=_after(number),
        deed=f"{{guess_{number}}}",
    )


def _after(number: int) -> str:
    return f"guess_{number + 1}" if number < _GUESSES else "leave"


_NUMBERS = range(1, _GUESSES + 1)
_STATES: dict[str, State] = {
    **{f"guess_{number}": _question(number) for number in _NUMBERS},
    **{f"told_{number}": _told(number) for number in _NUMBERS},
    "leave": AskState(
        text="I do not know where I am, and cannot go on. Shall I leave {doing} out?",
        yes="left_out",
        yes_effect="I leave {doing} out, and the task counts it as left out by you.",
        no="later",
        no_effect=ATTEMPT_FAILED,
        headline="say whether I leave {doing} out",
    ),
    "left_out": LeaveState(text="All right. I leave {doing} out.", deed="leave {doing} out"),
    "later": CloseState(text="All right.", resolution=Resolution.ROBOT_RETRY),
}

script = Script(
    opening="guess_1",
    failed_opening="leave",
    states=_STATES,
    put_right={Expectation.LOCATED: Resolution.ROBOT_FINISH},
    denied=frozenset({Expectation.LOCATED}),
)
