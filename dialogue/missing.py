"""The script for `missing`: put it on the table, and the robot goes on."""

from dialogue import place_branch
from dialogue.place_branch import Patience
from dialogue.script import AskState, Expectation, Help, HelpState, Script, ScriptWithParameters
from tasks.resolution import Resolution


def make_script(patience: Patience) -> Script:
    return Script(
        opening="can_you_bring_it",
        states={
            "can_you_bring_it": AskState(
                text="I cannot find the {object}. Can you put it on the table?",
                yes="put_on_table",
                yes_effect="You put the {object} on the table; I pick it up and place it.",
                no=place_branch.OPENING,
                no_effect=place_branch.OPENING_EFFECT,
            ),
            "put_on_table": HelpState(
                text="Please put the {object} on the table where I can reach it.",
                help=Help.PUT_BACK,
                resolution=Resolution.ROBOT_FINISH,
                thanks="Thank you. I see the {object} and go on.",
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


script = ScriptWithParameters(Patience, make_script)
