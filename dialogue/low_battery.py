"""The script for `low_battery`: plug the robot in, and it goes on once it holds enough."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="I cannot go on as I am.{why} Can you plug me in where I stand?",
        failed="I have now stood {times} with an empty battery.",
        deed="plug me in where I stand",
        yes_effect="You plug me in; I go on once my battery holds enough ({attempt}).",
        help=Help.CHARGE,
        request="Please plug me in where I stand. I wait until I feel current.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I feel current.",
        unchanged="I feel current.",
        not_seen="I do not feel any current yet. Are you still plugging me in?",
        given_up="I still do not feel any current.",
        goes_on="I go on once my battery holds enough",
        put_right={Expectation.CHARGED: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.CHARGED}),
        placeable=False,
    )
)
