"""The script for `blind`: clear the head camera's view, or mend it, and the robot goes on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="I cannot see what is on the table.{why} Can you clear the view of my head "
        "camera, or mend it?",
        failed="I have now found {times} that I cannot see what is on the table.{why}",
        deed="clear my head camera's view",
        yes_effect="You clear the view of my head camera, or mend it; I go on as soon as I see "
        "what is on the table ({attempt}).",
        help=Help.CLEAR_VIEW,
        request="Please clear the view of my head camera, or mend it. I wait until I see what is "
        "on the table.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I see what is on the table.",
        unchanged="I see what is on the table.",
        not_seen="I do not see what is on the table yet. Are you still at it?",
        put_right={Expectation.VIEW_CLEAR: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.VIEW_CLEAR}),
    )
)
