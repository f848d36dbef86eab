"""Which robots of fleets wait for people, for whoever follows what those do for them."""

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING
from uuid import UUID

from mend.server.fleets.views import RequestView, RobotWaitsView
from mend.server.runtime.views import DialogueView

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import RequestView as Booked

Waiting = Mapping[UUID, RobotWaitsView]
"""By the run that has a robot, what that waits for."""


def waiting_robots(open_dialogues: Iterable[DialogueView]) -> Waiting:
    """The robots that ask people, or watch for help that was promised; of several the first."""
    found: dict[UUID, RobotWaitsView] = {}
    for each in open_dialogues:
        prompt = each.prompt
        if each.scripted or prompt is None or each.awaiting is None:
            continue
        helper = each.help.helper if each.help is not None else None
        headline = prompt.headline or prompt.text
        waits = RobotWaitsView(
            robot=each.robot, dialogue=each.dialogue, headline=headline, helper=helper
        )
        found.setdefault(each.run, waits)
    return found


def followed(
    site: UUID, booked: "Booked", run_of: Callable[[str], UUID | None], waiting: Waiting
) -> RequestView:
    """How far a request has come, and what the robot waits for that is next to do something."""
    run = None if booked.expected is None else run_of(booked.expected.robot)
    return RequestView.of(site, booked, None if run is None else waiting.get(run))
