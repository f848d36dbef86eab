"""The branch that ends every refused offer (Blankenburg et al. 2020, Figure 3).

The robot asks whether the helper will place the object; if not, it tries again later. Where that
has failed before, or where nothing would be left to try, it first asks whether to leave it out.
"""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from mend.dialogue.script import (
    ATTEMPT_FAILED,
    AskState,
    CloseState,
    Help,
    HelpState,
    LeaveState,
    State,
)
from mend.documents.strict_model import StrictModel
from mend.tasks.resolution import Resolution

OPENING = "will_you_place"
OPENING_EFFECT = "I ask whether you will place the {object} yourself ({attempt})."

YES_EFFECT = "You put the {object} at its place; it is done once I see it there ({attempt})."
LEAVES = "leave {it} out"
LEAVE_EFFECT = f"I ask whether I shall {LEAVES} ({{attempt}})."


def leave_headline(leaves: str = LEAVES) -> str:
    """What is asked of whoever can only say whether something is left out."""
    return f"say whether I {leaves}"


def leaving(leaves: str = LEAVES) -> Mapping[str, State]:
    """The end of the branch, from `leave` on: `leaves` is what the robot does without the help."""
    return {
        "leave": AskState(
            text=f"Shall I {leaves}?",
            yes="left_out",
            yes_effect=f"I {leaves}, and the task counts it as left out by you.",
            no="later",
            no_effect=ATTEMPT_FAILED,
            if_refused=True,
            headline=leave_headline(leaves),
        ),
        "left_out": LeaveState(text=f"All right. I {leaves}.", deed=leaves),
        "later": CloseState(text="All right.", resolution=Resolution.ROBOT_RETRY),
    }


STATES: Mapping[str, State] = {
    OPENING: AskState(
        text="Will you place the {object} yourself?",
        yes="place",
        yes_effect=YES_EFFECT,
        no="leave",
        no_effect=LEAVE_EFFECT,
    ),
    "place": HelpState(
        text="Please put the {object} at its place; I am watching for it.",
        help=Help.PLACE,
        resolution=Resolution.HUMAN_FINISH,
        thanks="Thank you. I see the {object} at its place.",
        unchanged="I see the {object} at its place, where I saw it after I asked.",
        not_seen="I do not see the {object} at its place yet. Are you still placing it?",
        otherwise="leave",
        otherwise_effect=LEAVE_EFFECT,
        deed="place {it} yourself",
    ),
    **leaving(),
}


class Patience(StrictModel):
    """How often promised help that is not seen is asked about again before the robot gives up."""

    reasks: Annotated[int, Field(ge=0, le=20)] = 2
