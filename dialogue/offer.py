"""The flow that most scripts share: the robot asks for one kind of help, or else to place it.

Source: Blankenburg et al. 2020, Figure 3.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from mend.dialogue import place_branch
from mend.dialogue.place_branch import Patience
from mend.dialogue.script import (
    AskState,
    Expectation,
    Felt,
    Help,
    HelpState,
    Script,
    ScriptWithParameters,
)
from mend.tasks.issue import Sensed
from mend.tasks.resolution import Resolution

FAILED = "failed"


@dataclass(frozen=True, slots=True)
class Offer:
    """What a script asks for (`question`), what a yes means, and how the help is seen through.

    `deed` is that help in few words, and `deeds_felt` what is asked for about what is felt instead.

    `failed` says how often the robot has failed at this itself; it then no longer asks for `help`.
    `request` says what to do and `not_seen` asks for it again, or `not_felt` where a basket feels
    something else, until it is `given_up`; once `help` is seen the robot says
    `thanks` (or `unchanged`, where it was so before) and that it `goes_on`, and the dialogue closes
    with `resolution`.
    `put_right`, `denied` and `may_be_mistaken` are a script's. `placeable`: there is an object
    that a helper could place instead; else who refuses is only asked whether it `leaves` it out.
    Of a leaf that handles nothing the robot says `without_object`, where nothing could help but
    another object, and asks that at once.
    """

    question: str
    failed: str
    deed: str
    yes_effect: str
    help: Help
    request: str
    resolution: Resolution
    thanks: str
    unchanged: str
    not_seen: str
    put_right: Mapping[Expectation, Resolution]
    denied: frozenset[Expectation] = frozenset()
    may_be_mistaken: bool = False
    placeable: bool = True
    leaves: str = place_branch.LEAVES
    not_felt: Mapping[Felt, str] = field(default_factory=dict)
    deeds_felt: Mapping[Felt, str] = field(default_factory=dict)
    given_up: str = "I still do not see that help."
    goes_on: str = "I go on"
    without_object: str = ""


def offer_script(
    offer: Offer, variants: Mapping[Sensed, Offer] | None = None
) -> ScriptWithParameters[Patience]:
    """The script of an offer; a helper who refuses it is asked to place the object.

    `variants` are what is offered instead for what was sensed otherwise than by seeing it.
    """

    def make(patience: Patience) -> Script:
        others = (variants or {}).items()
        return _script(
            offer, patience, {sensed: _script(each, patience, {}) for sensed, each in others}
        )

    return ScriptWithParameters(Patience, make)


def _script(offer: Offer, patience: Patience, variants: Mapping[Sensed, Script]) -> Script:
    refused, refused_effect = place_branch.OPENING, place_branch.OPENING_EFFECT
    last = AskState(
        text=f"{offer.failed} Will you place the {{object}} yourself?",
        yes="place",
        yes_effect=place_branch.YES_EFFECT,
        no="leave",
        no_effect=place_branch.LEAVE_EFFECT,
    )
    branch = place_branch.STATES
    if not offer.placeable:
        branch = place_branch.leaving(offer.leaves)
        refused, refused_effect = "leave", f"I ask whether I shall {offer.leaves} ({{attempt}})."
        leave = branch["leave"]
        assert isinstance(leave, AskState), "the branch ends by asking whether to leave it out"
        last = replace(leave, text=f"{offer.failed} {leave.text}", if_refused=False)
    return Script(
        opening="question",
        failed_opening=FAILED,
        states={
            "question": AskState(
                text=offer.question,
                yes=str(offer.help),
                yes_effect=offer.yes_effect,
                no=refused,
                no_effect=refused_effect,
            ),
            str(offer.help): HelpState(
                text=offer.request,
                help=offer.help,
                resolution=offer.resolution,
                thanks=offer.thanks,
                unchanged=offer.unchanged,
                not_seen=offer.not_seen,
                otherwise=refused,
                otherwise_effect=refused_effect,
                not_felt=offer.not_felt,
                given_up=offer.given_up,
                deed=offer.deed,
                deeds_felt=offer.deeds_felt,
                goes_on=offer.goes_on,
            ),
            FAILED: last,
            **branch,
        },
        put_right=offer.put_right,
        denied=offer.denied,
        may_be_mistaken=offer.may_be_mistaken,
        reasks=patience.reasks,
        variants=variants,
        without_object=_without_object(offer, patience),
    )


def _without_object(offer: Offer, patience: Patience) -> Script | None:
    """The script where there is nothing to place; None if it is the same."""
    if not offer.placeable or offer.help is Help.PUT_BACK:
        return None
    if offer.help is not Help.HAND_OVER:
        return _script(replace(offer, placeable=False), patience, {})
    states = place_branch.leaving()
    leave = states["leave"]
    assert isinstance(leave, AskState), "the branch ends by asking whether to leave it out"
    leave = replace(leave, text=f"{offer.without_object} {leave.text}", if_refused=False)
    return Script(
        opening="leave", states={**states, "leave": leave}, may_be_mistaken=offer.may_be_mistaken
    )
