"""The scripts for `blocked`: clear the way or the place, and the robot goes on.

What was seen in the way is gone once it is seen gone. What was felt no camera can clear: it takes a
person's word, a look, and a slow try amid a step. What a laser saw is in the way of a base, which
has nothing to place.
"""

from dataclasses import replace

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.issue import Sensed
from mend.tasks.resolution import Resolution

SEEN = Offer(
    question="I cannot go on{with_object}.{why} Can you clear the way?",
    failed="I have now been stopped {times} on my way{with_object}.",
    deed="clear the way",
    yes_effect="You clear the way; I go on as soon as I see it free ({attempt}).",
    help=Help.CLEAR_WAY,
    request="Please clear the way. I wait until I see it free.",
    resolution=Resolution.ROBOT_FINISH,
    thanks="Thank you. I see my way free.",
    unchanged="I see nothing in my way.",
    not_seen="I do not see my way free yet. Are you still clearing it?",
    put_right={Expectation.WAY_CLEAR: Resolution.ROBOT_FINISH},
    denied=frozenset({Expectation.WAY_CLEAR}),
)

FELT = Offer(
    question="I felt something hold up my arm and stopped. Can you clear its way?",
    failed="I have now been held up {times}{with_object}.",
    deed="clear my arm's way",
    yes_effect="You clear the way of my arm. I give you time for that, then I look, and go on if I "
    "see and feel nothing in it ({attempt}).",
    help=Help.CLEAR_WAY,
    request="Please clear the way of my arm. I look whether it is free.",
    resolution=Resolution.ROBOT_FINISH,
    thanks="Thank you. I see my way free.",
    unchanged="I do not see what held up my arm.",
    not_seen="I still see or feel something in my way. Are you still clearing it?",
    put_right={},
)

BY_LASER = replace(
    SEEN,
    placeable=False,
    put_right={**SEEN.put_right, Expectation.LED_ROUND: Resolution.ROBOT_FINISH},
)

script = offer_script(SEEN, {Sensed.FELT: FELT, Sensed.BY_LASER: BY_LASER})
