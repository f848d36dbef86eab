"""The script for `item_taken`: put back what was taken out of the basket, and the robot goes on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Felt, Help
from mend.tasks.resolution import Resolution

_STILL = "My basket is still lighter than it was. Are you still putting back what was in it?"

script = offer_script(
    Offer(
        question="Something was taken out of my basket.{why} Can you put it back?",
        failed="I have now met a basket that was lighter than before {times}.",
        deed="put back what was in my basket",
        yes_effect="You put it back into my basket; I go on once I feel that it weighs what it "
        "did ({attempt}).",
        help=Help.PUT_IN,
        request="Please put it back into my basket. I wait until I feel it there.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. My basket weighs what it did.",
        unchanged="My basket weighs what it did.",
        not_seen=_STILL,
        not_felt={Felt.LIGHTER: _STILL},
        given_up="My basket is still lighter than it was.",
        put_right={Expectation.LOADED: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.LOADED}),
        placeable=False,
    )
)
