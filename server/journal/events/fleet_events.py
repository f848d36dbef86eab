"""Events of the fleet of a site: requests, plans, legs and errands."""

from typing import Any, Literal

from mend.server.journal.events.event import Author, EventModel
from mend.server.journal.events.site_events import SiteEvent


class FleetEvent(SiteEvent):
    """An event of the fleet of a site; `at_s` is of the site's clock."""

    at_s: float


class RequestChanged(FleetEvent):
    """A request was made, or has come further: `what` is wanted and how far that is.

    `robot` is to be done with it at `done_s`; None where no robot is to do anything for it.
    `author`: who has asked for this change.
    """

    type: Literal["request_changed"] = "request_changed"
    request: str
    what: dict[str, Any]
    status: str
    reason: str | None
    robot: str | None
    done_s: float | None
    author: Author | None = None


class PlannedTransfer(EventModel):
    """A request's thing is to change robots: what that saves, as planned.

    `sooner_s`: how much sooner it is delivered than by one robot alone; `less_m`: how much less far
    all robots drive. Both are None where one alone could not bring it.
    """

    request: str
    sooner_s: float | None
    less_m: float | None


class PlanChanged(FleetEvent):
    """The plan of a fleet became another one, and why; whom that touches.

    `said`: a sentence by request or robot. `transfers`: what is to change robots that was not
    before, or not from this robot; the journals of an older Mend do not tell.
    """

    type: Literal["plan_changed"] = "plan_changed"
    number: int
    reason: str
    requests: list[str]
    robots: list[str]
    said: dict[str, str]
    transfers: list[PlannedTransfer] = []


class FleetTold(FleetEvent):
    """An operator told a fleet something: what that was, as `took r0 out of service: a squeak`.

    `finder`: the robot, where one found it. `robot`, `in_service`: which one works no more, or
    again; None for anything else, and in the journals of an older Mend.
    """

    type: Literal["fleet_told"] = "fleet_told"
    told: str
    author: Author | None = None
    finder: str | None = None
    robot: str | None = None
    in_service: bool | None = None


class LegEvent(FleetEvent):
    """An event of one leg; `number` counts those of its robot."""

    robot: str
    number: int
    booking: str
    action: str
    place: str


class LegBegun(LegEvent):
    """A robot is sent to a place for a booking; `start` is the place that it was at before."""

    type: Literal["leg_begun"] = "leg_begun"
    start: str


class LegEnded(LegEvent):
    """What became of a leg, and where its robot is then; `reason`: why, where it was not done.

    Of what was done it says what is known of that, where its robot could not feel all of it.

    `driven_m`: how far its robot has driven meanwhile, by its wheels, and `barred_s` how long it
    stood on its way before what barred it; None where that is not known, and in the journals of an
    older Mend.
    """

    type: Literal["leg_ended"] = "leg_ended"
    outcome: str
    reason: str | None
    at: str
    driven_m: float | None = None
    barred_s: float | None = None


class ErrandBegun(FleetEvent):
    """A robot that carries out no leg is sent from `start` to a place: `author` wants it there.

    Without an author it goes out of another robot's way, or `charges` there.
    """

    type: Literal["errand_begun"] = "errand_begun"
    robot: str
    place: str
    start: str
    author: Author | None = None
    charges: bool = False


class ErrandEnded(FleetEvent):
    """Whether it has come there, why where it has not, and the place that it is at then."""

    type: Literal["errand_ended"] = "errand_ended"
    robot: str
    place: str
    came: bool
    reason: str | None
    at: str
