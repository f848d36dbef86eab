"""The branch that ends every refused offer (Blankenburg et al. 2020, Figure 3).

The robot asks whether the helper will place the object; if not, it will try again later.
"""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from dialogue.script import AskState, CloseState, Help, HelpState, State
from tasks.resolution import Resolution
from tasks.scene import StrictModel

OPENING = "will_you_place"
OPENING_EFFECT = "I ask whether you will place the {object} yourself."

STATES: Mapping[str, State] = {
    OPENING: AskState(
        text="Will you place the {object} yourself?",
        yes="place",
        yes_effect="You put the {object} at its place; it is done once I see it there.",
        no="later",
        no_effect="I try again later.",
    ),
    "place": HelpState(
        text="Thank you. Please put the {object} at its place; I am watching for it.",
        help=Help.PLACE,
        resolution=Resolution.HUMAN_FINISH,
        thanks="Thank you. I see the {object} at its place.",
        not_seen="I do not see the {object} at its place yet. Are you still placing it?",
        otherwise="later",
        otherwise_effect="I try again later.",
    ),
    "later": CloseState(
        text="All right. I will try again later.", resolution=Resolution.ROBOT_RETRY
    ),
}


class Patience(StrictModel):
    """How often promised help that is not seen is asked about again before the robot gives up."""

    reasks: Annotated[int, Field(ge=0, le=20)] = 2
