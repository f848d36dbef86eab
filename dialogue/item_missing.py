"""The script for `item_missing`: who was given nothing hands nothing over."""

from mend.dialogue.place_branch import LEAVES, leave_headline
from mend.dialogue.script import ATTEMPT_FAILED, AskState, CloseState, LeaveState, Script
from mend.tasks.resolution import Resolution

script = Script(
    opening="question",
    states={
        "question": AskState(
            text="I am to hand over the {item} at {place}, but I was not given it. Shall I leave "
            "that out?",
            yes="left_out",
            yes_effect="I hand nothing over, and the task counts the {item} as left out by you.",
            no="later",
            no_effect=ATTEMPT_FAILED,
            headline=leave_headline(),
        ),
        "left_out": LeaveState(text="All right. I hand nothing over.", deed=LEAVES),
        "later": CloseState(text="All right.", resolution=Resolution.ROBOT_RETRY),
    },
)
