"""The script for `item_not_taken`: take it out of the basket, and the robot goes on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Felt, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="Please take the {item} out of my basket.{why} Will you do that?",
        failed="I have now waited {times} for the {item} to be taken out of my basket.",
        deed="take {it} out of my basket",
        yes_effect="You take the {item} out of my basket; I go on once I feel that my basket is "
        "lighter by it ({attempt}).",
        help=Help.TAKE_OUT,
        request="Please take the {item} out of my basket. I wait until I feel that it is lighter.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I feel that my basket is lighter.",
        unchanged="I feel that my basket is lighter.",
        not_seen="I do not feel my basket any lighter. Are you still taking the {item} out?",
        not_felt={
            Felt.HEAVIER: "My basket is heavier than it was, not lighter. Will you take the {item} "
            "out, and what was put in?",
            Felt.ANOTHER: "My basket is lighter, but not by as much as when I was given the "
            "{item}. Will you put back what is not the {item}, and take that out?",
        },
        deeds_felt={
            Felt.HEAVIER: "take {it} out, and what was put in",
            Felt.ANOTHER: "take out only the {item}",
        },
        given_up="I still do not feel the {item} taken out of my basket.",
        put_right={Expectation.UNLOADED: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.UNLOADED}),
        placeable=False,
    )
)
