"""What clients see of requests and of the fleet that meets them."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any
from uuid import UUID

from mend.fleet.requests import RequestStatus
from mend.server.runtime.views import View

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import RequestView as Booked
    from mend.fleet.dispatch.dispatcher import Dispatcher


class ExpectedView(View):
    """When a robot begins with a request, and is done with it (the site's clock, seconds).

    `place`: where it goes first.
    """

    robot: str
    place: str
    begins_s: float
    done_s: float


class RequestView(View):
    """How far a request has come. `what`: as it was asked; `reason`: why it is not as asked."""

    name: str
    site: UUID
    what: dict[str, Any]
    status: RequestStatus
    reason: str | None
    expected: ExpectedView | None

    @classmethod
    def of(cls, site: UUID, booked: "Booked") -> "RequestView":
        """What is told of a booking."""
        expected = booked.expected
        return cls(
            name=booked.name,
            site=site,
            what=booked.request.model_dump(mode="json", exclude_none=True),
            status=booked.status,
            reason=booked.reason,
            expected=None
            if expected is None
            else ExpectedView(
                robot=expected.robot,
                place=expected.place,
                begins_s=expected.begins_s,
                done_s=expected.done_s,
            ),
        )


class PlannedStop(View):
    """What a robot is to do; it may be `slack_s` late before anything breaks."""

    place: str
    action: str
    request: str
    begins_s: float
    slack_s: float


class FleetRobot(View):
    """A robot of a fleet: whether it works, what it has aboard, and what is still to be done.

    `out_of_service`: why somebody has taken it out; None where nobody has.
    """

    robot: str
    works: bool
    out_of_service: str | None
    aboard: list[str]
    stops: list[PlannedStop]


class PlanChangeView(View):
    """Why a plan became another one, and whom that touches."""

    number: int
    at_s: float
    reason: str
    requests: list[str]
    robots: list[str]


class FleetView(View):
    """A fleet at work, at `now_s` of its site's clock; the latest change of its plan comes last.

    `places`: where robots may be asked to come, as `FLOOR/PLACE`.
    """

    site: UUID
    now_s: float
    places: list[str]
    robots: list[FleetRobot]
    closed: list[list[str]]
    changes: list[PlanChangeView]

    @classmethod
    def of(
        cls,
        site: UUID,
        places: Sequence[str],
        out_of_service: Mapping[str, str],
        dispatcher: "Dispatcher",
    ) -> "FleetView":
        """What is told of the fleet of a site."""
        running, stops = dispatcher.fleet, dispatcher.fleet.stops()
        names = list(running.robots)
        aboard: dict[str, list[str]] = {name: [] for name in names}
        for name, item in running.items.items():
            if item.robot is not None and item.open:
                aboard[names[item.robot]].append(name)
        return cls(
            site=site,
            now_s=dispatcher.now_s,
            places=list(places),
            robots=[
                FleetRobot(
                    robot=name,
                    works=robot.works,
                    out_of_service=out_of_service.get(name),
                    aboard=aboard[name],
                    stops=[
                        PlannedStop(
                            place=each.place,
                            action=each.action,
                            request=each.item,
                            begins_s=each.begin_s,
                            slack_s=min(each.slack_s, 1e9),
                        )
                        for each in stops[name]
                    ],
                )
                for name, robot in running.robots.items()
            ],
            closed=[sorted(each) for each in dispatcher.closed_until_s()],
            changes=[
                PlanChangeView(
                    number=each.number,
                    at_s=each.at_s,
                    reason=each.reason,
                    requests=list(each.requests),
                    robots=list(each.robots),
                )
                for each in dispatcher.log
            ],
        )
