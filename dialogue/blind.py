"""The script for `blind`: clear the head camera's view, and the robot goes on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="I cannot see the table.{why} Can you clear the view of my head camera?",
        failed="I have now found {times} that I cannot see the table.{why}",
        yes_effect="You clear the view of my head camera; I go on as soon as I see the table "
        "({attempt}).",
        help=Help.CLEAR_VIEW,
        request="Please clear the view of my head camera. I wait until I see the table.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I see the table.",
        unchanged="I see the table.",
        not_seen="I do not see the table yet. Are you still clearing my view?",
        put_right={Expectation.VIEW_CLEAR: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.VIEW_CLEAR}),
    )
)
