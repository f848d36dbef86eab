"""The script for `undone`: what was placed is not at its place, or no longer.

Where the robot sees the object stand in reach it only says so, and places it again. Where it sees
it nowhere somebody has to bring it.
"""

from collections.abc import Mapping
from dataclasses import replace

from mend.dialogue.missing import PUT_RIGHT
from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.place_branch import Patience
from mend.dialogue.script import CloseState, Help, Script, ScriptWithParameters, State
from mend.tasks.issue import Sensed
from mend.tasks.resolution import Resolution

_SEEN = Offer(
    question="The {object} is not at its place.{why} Will you put it within my reach?",
    failed="I have now seen {times} that the {object} is not at its place.",
    deed="put {it} within my reach",
    yes_effect="You put the {object} where I can reach it; I place it again ({attempt}).",
    help=Help.PUT_BACK,
    request="Please put the {object} on the table where I can reach it.",
    resolution=Resolution.ROBOT_FINISH,
    thanks="Thank you. I see the {object}.",
    unchanged="I see the {object}, where I saw it after I asked.",
    not_seen="I do not see the {object} where I can reach it yet. Are you still bringing it?",
    put_right=PUT_RIGHT,
)

_NOWHERE = replace(
    _SEEN,
    question="The {object} is not at its place, and I see it nowhere. Can you bring it back?",
    yes_effect="You put the {object} on the table where I can reach it; I place it again "
    "({attempt}).",
    unchanged="I see the {object} now, where it was when I looked again.",
    denied=frozenset(PUT_RIGHT),
)

_OFFER = offer_script(_SEEN, {Sensed.NOWHERE: _NOWHERE})

_AGAIN: Mapping[str, State] = {
    "again": CloseState(
        text="The {object} is not at its place. I place it again.",
        resolution=Resolution.ROBOT_FINISH,
    )
}


def _make(patience: Patience) -> Script:
    script = _OFFER.make(patience)
    variants = {sensed: _with_again(each) for sensed, each in script.variants.items()}
    return replace(_with_again(script), variants=variants)


def _with_again(script: Script) -> Script:
    return replace(script, on_the_way="again", states={**script.states, **_AGAIN})


script = ScriptWithParameters(Patience, _make)
