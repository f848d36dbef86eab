"""The script for `undone`: what was placed is not at its place, or no longer.

Where the robot sees the object stand in reach it only says so, and places it again.
"""

from dataclasses import replace

from dialogue.missing import PUT_RIGHT
from dialogue.offer import Offer, offer_script
from dialogue.place_branch import Patience
from dialogue.script import CloseState, Help, Script, ScriptWithParameters
from tasks.resolution import Resolution

_OFFER = offer_script(
    Offer(
        question="The {object} is not at its place. Shall I place it again?",
        failed="I have now seen {times} that the {object} is not at its place.",
        yes_effect="You put the {object} where I can reach it; I place it again ({attempt}).",
        help=Help.PUT_BACK,
        request="Please put the {object} on the table where I can reach it.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I see the {object}.",
        unchanged="I see the {object}, where it was before.",
        not_seen="I do not see the {object} where I can reach it yet. Are you still bringing it?",
        put_right=PUT_RIGHT,
    )
)


def _make(patience: Patience) -> Script:
    script = _OFFER.make(patience)
    again = CloseState(
        text="The {object} is not at its place. I place it again.",
        resolution=Resolution.ROBOT_FINISH,
    )
    return replace(script, on_the_way="again", states={**script.states, "again": again})


script = ScriptWithParameters(Patience, _make)
