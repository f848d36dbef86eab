"""Who helps, as everybody may see it: who is here, away, called or not to be reached, and busy."""

from typing import Literal

from pydantic import BaseModel, ConfigDict

from mend.server.dialogues.duty import Duty
from mend.server.dialogues.escalation import EscalationPolicy

Reach = Literal["here", "away", "called", "gone"]
"""At a page of theirs; signed in, but at none of their pages; not signed in, but with a device that
is called; or neither, so that nothing calls them."""


class HelperView(BaseModel):
    """One helper. `on` dialogues they have claimed or promised help in; `asked` so many questions.

    Since when somebody is here or away is told to nobody.
    """

    model_config = ConfigDict(frozen=True)

    helper: str
    reach: Reach
    on: int
    asked: int


class HelpersView(BaseModel):
    """Everybody who helps. `in_turn`: one is asked after the other; else everybody at once."""

    model_config = ConfigDict(frozen=True)

    in_turn: bool
    helpers: list[HelperView]


def who_helps(policy: EscalationPolicy, duty: Duty) -> HelpersView:
    """The policy's helpers in their order, then who else is signed in.

    Where the policy names nobody everybody is asked, so whoever is called is there as well.
    """
    others = [*duty.there, *(() if policy.helpers else sorted(duty.called))]
    names = dict.fromkeys([*policy.helpers, *others])
    return HelpersView(in_turn=bool(policy.helpers), helpers=[_view(each, duty) for each in names])


def _view(helper: str, duty: Duty) -> HelperView:
    return HelperView(
        helper=helper,
        reach=_reach(helper, duty),
        on=len({dialogue for dialogue, by in duty.on if by == helper}),
        asked=sum(each.helper == helper for each in duty.questions),
    )


def _reach(helper: str, duty: Duty) -> Reach:
    if helper in duty.there:
        return "away" if helper in duty.away else "here"
    return "called" if helper in duty.called else "gone"
