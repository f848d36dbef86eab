"""The flow that most scripts share: the robot asks for one kind of help, or else to place it.

Source: Blankenburg et al. 2020, Figure 3.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from dialogue import place_branch
from dialogue.place_branch import Patience
from dialogue.script import (
    AskState,
    Expectation,
    Help,
    HelpState,
    Script,
    ScriptWithParameters,
)
from tasks.resolution import Resolution


@dataclass(frozen=True, slots=True)
class Offer:
    """What a script asks for (`question`), what a yes means, and how the help is seen through.

    `request` says what to do and `not_seen` asks for it again; once `help` is seen the robot says
    `thanks` and the dialogue closes with `resolution`. `put_right` is a script's.
    """

    question: str
    yes_effect: str
    help: Help
    request: str
    resolution: Resolution
    thanks: str
    not_seen: str
    put_right: Mapping[Expectation, Resolution]


def offer_script(offer: Offer) -> ScriptWithParameters[Patience]:
    """The script of an offer; a helper who refuses it is asked to place the object."""

    def make(patience: Patience) -> Script:
        return Script(
            opening="question",
            states={
                "question": AskState(
                    text=offer.question,
                    yes="request",
                    yes_effect=offer.yes_effect,
                    no=place_branch.OPENING,
                    no_effect=place_branch.OPENING_EFFECT,
                ),
                "request": HelpState(
                    text=offer.request,
                    help=offer.help,
                    resolution=offer.resolution,
                    thanks=offer.thanks,
                    not_seen=offer.not_seen,
                    otherwise=place_branch.OPENING,
                    otherwise_effect=place_branch.OPENING_EFFECT,
                ),
                **place_branch.STATES,
            },
            put_right=offer.put_right,
            reasks=patience.reasks,
        )

    return ScriptWithParameters(Patience, make)
