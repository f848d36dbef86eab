"""The flow that `missed` and `dropped` share: put it back for another try, or place it yourself."""

from dialogue import place_branch
from dialogue.place_branch import Patience
from dialogue.script import AskState, Expectation, Help, HelpState, Script
from tasks.resolution import Resolution


def lost_part_script(what_happened: str, patience: Patience) -> Script:
    """The script for an object that the robot has not got; `what_happened` is its first sentence.

    Source: Blankenburg et al. 2020, Section 3.3.
    """
    return Script(
        opening="shall_i_retry",
        states={
            "shall_i_retry": AskState(
                text=f"{what_happened} Shall I try again?",
                yes="put_back",
                yes_effect="You put the {object} back on the table; I pick it up later.",
                no=place_branch.OPENING,
                no_effect=place_branch.OPENING_EFFECT,
            ),
            "put_back": HelpState(
                text="Please put the {object} back where it was on the table. "
                "I will pick it up later.",
                help=Help.PUT_BACK,
                resolution=Resolution.ROBOT_RETRY,
                thanks="Thank you. I see the {object} and will pick it up later.",
                not_seen="I do not see the {object} on the table yet. "
                "Are you still putting it back?",
                otherwise=place_branch.OPENING,
                otherwise_effect=place_branch.OPENING_EFFECT,
            ),
            **place_branch.STATES,
        },
        put_right={
            Expectation.AT_PLACE: Resolution.HUMAN_FINISH,
            Expectation.IN_REACH: Resolution.ROBOT_RETRY,
        },
        reasks=patience.reasks,
    )
