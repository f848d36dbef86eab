"""The script for `undone`: what was placed is not at its place, or no longer.

Where the robot sees the object in reach it only says so, and places it again.
"""

from dialogue import place_branch
from dialogue.place_branch import Patience
from dialogue.script import (
    AskState,
    CloseState,
    Expectation,
    Help,
    HelpState,
    Script,
    ScriptWithParameters,
)
from tasks.resolution import Resolution


def _make(patience: Patience) -> Script:
    return Script(
        opening="question",
        on_the_way="again",
        states={
            "again": CloseState(
                text="The {object} is not at its place. I place it again.",
                resolution=Resolution.ROBOT_FINISH,
            ),
            "question": AskState(
                text="The {object} is not at its place. Shall I place it again?",
                yes="request",
                yes_effect="You put the {object} where I can reach it; I place it again "
                "({attempt}).",
                no=place_branch.OPENING,
                no_effect=place_branch.OPENING_EFFECT,
            ),
            "request": HelpState(
                text="Please put the {object} on the table where I can reach it. I place it as "
                "soon as I see it there.",
                help=Help.PUT_BACK,
                resolution=Resolution.ROBOT_FINISH,
                thanks="Thank you. I see the {object}.",
                unchanged="I see the {object}.",
                not_seen="I do not see the {object} on the table yet. Are you still bringing it?",
                otherwise=place_branch.OPENING,
                otherwise_effect=place_branch.OPENING_EFFECT,
            ),
            **place_branch.STATES,
        },
        put_right={
            Expectation.AT_PLACE: Resolution.HUMAN_FINISH,
            Expectation.IN_REACH: Resolution.ROBOT_FINISH,
        },
        reasks=patience.reasks,
    )


script = ScriptWithParameters(Patience, _make)
