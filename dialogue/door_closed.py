"""The script for `door_closed`: open the door, and the robot goes on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="I cannot go on.{why} Can you open the door?",
        failed="I have now been stopped {times} by a shut door.",
        deed="open the door",
        yes_effect="You open the door; I go on as soon as I see it open ({attempt}).",
        help=Help.CLEAR_WAY,
        request="Please open the door. I wait until I see it open.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I see the door open.",
        unchanged="I see no shut door before me.",
        not_seen="I do not see the door open yet. Are you still opening it?",
        put_right={
            Expectation.WAY_CLEAR: Resolution.ROBOT_FINISH,
            Expectation.LED_ROUND: Resolution.ROBOT_FINISH,
        },
        denied=frozenset({Expectation.WAY_CLEAR}),
        placeable=False,
    )
)
