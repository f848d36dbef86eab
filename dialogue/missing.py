"""The script for `missing`: put it on the table, and the robot goes on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

PUT_RIGHT = {
    Expectation.AT_PLACE: Resolution.HUMAN_FINISH,
    Expectation.IN_REACH: Resolution.ROBOT_FINISH,
}

script = offer_script(
    Offer(
        question="I cannot find the {object}. Can you put it on the table where I see it?",
        failed="I have now looked {times} for the {object} and cannot find it.",
        deed="put {it} on the table",
        yes_effect="You put the {object} on the table; I pick it up and place it ({attempt}).",
        help=Help.PUT_BACK,
        request="Please put the {object} on the table where I can reach it.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I see the {object}.",
        unchanged="I see the {object} now, where it was when I looked again.",
        not_seen="I do not see the {object} where I can reach it yet. Are you still bringing it?",
        put_right=PUT_RIGHT,
        denied=frozenset(PUT_RIGHT),
    )
)
