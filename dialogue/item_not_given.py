"""The script for `item_not_given`: put it into the basket, and the robot goes on."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Felt, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="Please {put_in}.{why} Will you do that?",
        failed="I have now waited {times} to be given the {item}.",
        deed="{fetch}",
        yes_effect="You {put_in}; I go on once I feel something new in my basket ({attempt}).",
        help=Help.PUT_IN,
        request="Please {put_in}. I wait until I feel something new in my basket.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I feel something new in my basket.",
        unchanged="I feel something new in my basket.",
        not_seen="I feel nothing new in my basket. Are you still putting the {item} into it?",
        not_felt={
            Felt.TOO_LITTLE: "I feel very little that is new in my basket, too little for the "
            "{item}. Are you still putting it in?",
            Felt.TOO_MUCH: "My basket is heavier now than I can carry. Will you take out what is "
            "not the {item}?",
            Felt.LIGHTER: "My basket is lighter than it was, not heavier. Will you put back what "
            "was taken out, and the {item} in?",
        },
        deeds_felt={
            Felt.TOO_MUCH: "take out what is not the {item}",
            Felt.LIGHTER: "put {it} in, and what was taken out",
        },
        given_up="I still do not feel in my basket what I came for.",
        put_right={Expectation.LOADED: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.LOADED}),
        placeable=False,
    )
)
