"""The script for `unreachable`: hand it over (Blankenburg et al. 2020, Section 3.3)."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Felt, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="I cannot reach the {object}.{why} Can you hand it to me?",
        failed="I have now tried {times} and cannot reach the {object}.{why}",
        deed="hold {it} between my fingers",
        yes_effect="You hold the {object} between my fingers; I take it and place it ({attempt}).",
        help=Help.HAND_OVER,
        request="Please hold the {object} between my fingers until I have gripped it.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I have the {object} between my fingers.",
        unchanged="I have the {object} between my fingers.",
        not_seen="I do not see the {object} between my fingers yet. Are you still handing it over?",
        not_felt={
            Felt.ANOTHER: "What I was handed does not look like the {object}. Are you still "
            "handing it over?"
        },
        put_right={
            Expectation.AT_PLACE: Resolution.HUMAN_FINISH,
            Expectation.IN_REACH: Resolution.ROBOT_FINISH,
        },
        may_be_mistaken=True,
        without_object="I cannot do the {object}.{why}",
    )
)
