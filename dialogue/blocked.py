"""The script for `blocked`: clear the way or the place, and the robot goes on."""

from dialogue.offer import Offer, offer_script
from dialogue.script import Expectation, Help
from tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="Something is in my way, on the {object} or at its place. Can you clear it away?",
        yes_effect="You clear it away; I go on as soon as I see that the way is free.",
        help=Help.CLEAR_WAY,
        request="Please clear it away. I wait until I see that my way is free.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. The way is free and I go on.",
        not_seen="I do not see my way free yet. Are you still clearing it?",
        put_right={Expectation.WAY_CLEAR: Resolution.ROBOT_FINISH},
    )
)
