"""The script for `elevator_help`: call the elevator, press the button, and the robot rides."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="I need help with an elevator.{why} Can you call it and press my button in it?",
        failed="I have now got no farther {times} for want of an elevator.",
        deed="call the elevator and press my button",
        yes_effect="You call the elevator and press the button; I go on once it is open "
        "({attempt}).",
        help=Help.CLEAR_WAY,
        request="Please call the elevator, and press the button of my floor in it. I watch for it.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I see the elevator open.",
        unchanged="I see the elevator open for me.",
        not_seen="I do not see the elevator open where I need it yet. Are you still seeing to it?",
        put_right={
            Expectation.WAY_CLEAR: Resolution.ROBOT_FINISH,
            Expectation.LED_ROUND: Resolution.ROBOT_FINISH,
        },
        denied=frozenset({Expectation.WAY_CLEAR}),
        placeable=False,
    )
)
