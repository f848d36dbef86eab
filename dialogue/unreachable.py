"""The script for `unreachable`: hand it over (Blankenburg et al. 2020, Section 3.3)."""

from dialogue import place_branch
from dialogue.place_branch import Patience
from dialogue.script import AskState, Expectation, Help, HelpState, Script, ScriptWithParameters
from tasks.resolution import Resolution


def make_script(patience: Patience) -> Script:
    return Script(
        opening="can_you_hand_over",
        states={
            "can_you_hand_over": AskState(
                text="I cannot reach the {object}. Can you hand it to me?",
                yes="hand_over",
                yes_effect="You hold the {object} between my fingers; I take it and place it.",
                no=place_branch.OPENING,
                no_effect=place_branch.OPENING_EFFECT,
            ),
            "hand_over": HelpState(
                text="Please hold the {object} between my fingers until I have gripped it.",
                help=Help.HAND_OVER,
                resolution=Resolution.ROBOT_FINISH,
                thanks="Thank you. I have the {object} and will place it.",
                not_seen="I do not see the {object} between my fingers yet. "
                "Are you still handing it over?",
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


script = ScriptWithParameters(Patience, make_script)
