"""The script for `wrong_floor`: press the right button, and the robot rides on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="I am at the wrong floor.{why} Can you press the button for my floor?",
        failed="I have now come to a wrong floor {times}.",
        deed="press the button for my floor",
        yes_effect="You press the button; I ride on, and get out once I am there ({attempt}).",
        help=Help.CLEAR_WAY,
        request="Please press the button for my floor. I stay in the elevator until I am there.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I am at my floor now.",
        unchanged="I am at my floor now.",
        not_seen="I am not at my floor yet. Are you still seeing to the button?",
        put_right={Expectation.WAY_CLEAR: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.WAY_CLEAR}),
        placeable=False,
    )
)
