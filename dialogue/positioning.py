"""The script for `positioning`: the robot asks for help with placing, and goes on slowly meanwhile.

Nothing waits for the answer: a yes makes it work of both, anything else the robot's own.
Source: Blankenburg et al. 2020, Section 3.3.
"""

from mend.dialogue.script import AskState, CloseState, Script
from mend.tasks.resolution import Resolution

ALONE_EFFECT = "I place the {object} slowly by myself."

script = Script(
    opening="help_me",
    states={
        "help_me": AskState(
            text="Please help me position the {object} now; I place it slowly. Are you helping?",
            yes="together",
            yes_effect="You help while I place the {object} slowly; both of us have done it then.",
            no="alone",
            no_effect=ALONE_EFFECT,
            unanswered="alone",
            unanswered_effect=ALONE_EFFECT,
        ),
        "together": CloseState(
            text="All right. I place it slowly.",
            resolution=Resolution.COLLAB_FINISH,
            deed="help me position {it} now",
        ),
        "alone": CloseState(
            text="I place it slowly by myself.", resolution=Resolution.ROBOT_FINISH
        ),
    },
)
