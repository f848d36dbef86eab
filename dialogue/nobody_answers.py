"""The script for `nobody_answers`: say that the message was heard, which nothing else tells."""

from mend.dialogue.script import ATTEMPT_FAILED, AskState, CloseState, LeaveState, Script
from mend.tasks.resolution import Resolution

script = Script(
    opening="question",
    states={
        "question": AskState(
            text='I have a message for {place}: "{message}" Have you heard it there?',
            yes="heard",
            yes_effect="I take your word that the message was heard, and {go_on}.",
            no="leave",
            no_effect="I ask whether I shall leave the message untold ({attempt}).",
            headline="say whether the message was heard",
        ),
        "heard": CloseState(
            text="Thank you. I take your word that the message was heard.",
            resolution=Resolution.ROBOT_FINISH,
            deed="it was heard",
        ),
        "leave": AskState(
            text="Shall I leave the message for {place} untold?",
            yes="left_out",
            yes_effect="I tell it no more, and the task counts the message as left out by you.",
            no="later",
            no_effect=ATTEMPT_FAILED,
            if_refused=True,
            headline="say whether the message stays untold",
        ),
        "left_out": LeaveState(
            text="All right. The message was not heard, and I go on.", deed="leave it untold"
        ),
        "later": CloseState(text="All right.", resolution=Resolution.ROBOT_RETRY),
    },
)
