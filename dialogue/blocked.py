"""The script for `blocked`: clear the way, and the robot goes on."""

from dialogue import place_branch
from dialogue.place_branch import Patience
from dialogue.script import AskState, Expectation, Help, HelpState, Script, ScriptWithParameters
from tasks.resolution import Resolution


def make_script(patience: Patience) -> Script:
    return Script(
        opening="can_you_clear_the_way",
        states={
            "can_you_clear_the_way": AskState(
                text="Something is in the way of my arm. Can you clear the way?",
                yes="clear_way",
                yes_effect="You clear the way; I go on as soon as I see that it is free.",
                no=place_branch.OPENING,
                no_effect=place_branch.OPENING_EFFECT,
            ),
            "clear_way": HelpState(
                text="Please clear the way. I wait until it is free.",
                help=Help.CLEAR_WAY,
                resolution=Resolution.ROBOT_FINISH,
                thanks="Thank you. The way is free and I go on.",
                not_seen="My way is not free yet. Are you still clearing it?",
                otherwise=place_branch.OPENING,
                otherwise_effect=place_branch.OPENING_EFFECT,
            ),
            **place_branch.STATES,
        },
        put_right={Expectation.WAY_CLEAR: Resolution.ROBOT_FINISH},
        reasks=patience.reasks,
    )


script = ScriptWithParameters(Patience, make_script)
