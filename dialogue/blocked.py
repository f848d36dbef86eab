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
                text="Something is in my way or where the {object} belongs. Can you clear it away?",
                yes="clear_way",
                yes_effect="You clear it away; I go on as soon as I see that the way is free.",
                no=place_branch.OPENING,
                no_effect=place_branch.OPENING_EFFECT,
            ),
            "clear_way": HelpState(
                text="Please clear my way and the place. I wait until I see that both are free.",
                help=Help.CLEAR_WAY,
                resolution=Resolution.ROBOT_FINISH,
                thanks="Thank you. The way is free and I go on.",
                not_seen="I do not see my way and the place free yet. Are you still clearing them?",
                otherwise=place_branch.OPENING,
                otherwise_effect=place_branch.OPENING_EFFECT,
            ),
            **place_branch.STATES,
        },
        put_right={Expectation.WAY_CLEAR: Resolution.ROBOT_FINISH},
        reasks=patience.reasks,
    )


script = ScriptWithParameters(Patience, make_script)
