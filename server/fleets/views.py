"""What clients see of requests and of the fleet that meets them."""

from math import atan2
from typing import TYPE_CHECKING, Any, Literal
from uuid import UUID

from mend.fleet.requests import LegAction, RequestStatus
from mend.server.runtime.views import View

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import RequestView as Booked
    from mend.fleet.dispatch.dispatcher import Dispatcher
    from mend.fleet.scheduling.replanning.live_plan import NextStop
    from mend.server.fleets.closed_ways import ClosedWay
    from mend.server.fleets.fleet_at_work import FleetAtWork
    from mend.server.poses.bases import SeenBase


class ExpectedView(View):
    """When a robot begins with a request, and is done with it (the site's clock, seconds).

    `place`: where it goes first. `late_s`: how much later than planned that is, as something is not
    done yet that was to be done by now; the times are then the earliest that are left.
    """

    robot: str
    place: str
    begins_s: float
    done_s: float
    late_s: float = 0.0


class RobotWaitsView(View):
    """A robot that waits for people in a dialogue: what it asks, or, once somebody (`helper`) has
    promised help, what that is about."""

    robot: str
    dialogue: UUID
    headline: str
    helper: str | None


class RequestView(View):
    """How far a request has come. `what`: as it was asked; `reason`: why it is not as asked.

    Of what is done it says what is known of that, where its robot could not feel all of it.
    `waits`: its robot waits for people; None where it does not.
    """

    name: str
    site: UUID
    what: dict[str, Any]
    status: RequestStatus
    reason: str | None
    expected: ExpectedView | None
    waits: RobotWaitsView | None = None

    @classmethod
    def of(cls, site: UUID, booked: "Booked", waits: RobotWaitsView | None = None) -> "RequestView":
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
                late_s=expected.late_s,
            ),
            waits=waits,
        )


class PlannedStop(View):
    """What a robot is to do at a place; it may be `slack_s` late at that.

    `partner`: the robot that takes what is given here, or gives what is taken here.
    """

    place: str
    action: LegAction
    request: str
    begins_s: float
    done_s: float
    slack_s: float
    partner: str | None


class RobotPose(View):
    """Where a robot says that it is, in the scene's frame; `age_s`: how long ago.

    `covariance`: of its place, xx, xy, yy (m2); None where it does not tell.
    """

    x: float
    y: float
    z: float
    yaw: float
    age_s: float
    covariance: list[float] | None

    @classmethod
    def of(cls, base: "SeenBase") -> "RobotPose":
        """What is told of a base."""
        x, y, z, qx, qy, qz, qw = base.pose
        yaw = atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz))
        covariance = None if base.covariance is None else list(base.covariance)
        return cls(x=x, y=y, z=z, yaw=yaw, age_s=base.age_s, covariance=covariance)


class FleetLeg(View):
    """What a robot is at: for a request, or (None) to a place where somebody wants it.

    `charges`: it goes there to charge, by itself.
    """

    place: str
    action: LegAction | None
    request: str | None
    charges: bool = False


class FleetRobot(View):
    """A robot of a fleet: whether it works, where it is, what it has aboard, is at and is to do.

    `out_of_service`: why somebody has taken it out; None where nobody has. `home`: its first place,
    or the nearest to which robots are sent; `run`: which has it now. `battery`: what that holds, as
    a share; None where it does not run out.
    """

    robot: str
    works: bool
    connected: bool
    out_of_service: str | None
    home: str
    run: UUID | None
    pose: RobotPose | None
    battery: float | None
    aboard: list[str]
    at_work: FleetLeg | None
    stops: list[PlannedStop]


class ClosedWayView(View):
    """A way between two places that no plan uses until `until_s`, and who has found that."""

    between: list[str]
    finding: Literal["blocked", "door_closed"] | None
    by: str | None
    until_s: float

    @classmethod
    def of(cls, way: "ClosedWay") -> "ClosedWayView":
        """What is told of a closed way."""
        told = way.told
        return cls(
            between=list(way.between),
            finding=None if told is None else "door_closed" if told.is_door else "blocked",
            by=None if told is None else told.by,
            until_s=way.until_s,
        )


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
    closed: list[ClosedWayView]
    changes: list[PlanChangeView]

    @classmethod
    def of(cls, fleet: "FleetAtWork", dispatcher: "Dispatcher") -> "FleetView":
        """What is told of the fleet of a site."""
        return cls(
            site=fleet.site,
            now_s=fleet.shown_s,
            places=fleet.places.names,
            robots=_robots(fleet, dispatcher),
            closed=[ClosedWayView.of(each) for each in fleet.closed_ways.now()],
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


def _robots(fleet: "FleetAtWork", dispatcher: "Dispatcher") -> list[FleetRobot]:
    running, stops = dispatcher.fleet, dispatcher.stops()
    names = list(running.robots)
    aboard: dict[str, list[str]] = {name: [] for name in names}
    for name, item in running.items.items():
        # Also what a robot still has that works no more, and from which others fetch it.
        has = item.held_by if item.robot is None else item.robot
        if has is not None:
            aboard[names[has]].append(name)
    homes = {each.name: fleet.places.home(each.start) for each in dispatcher.setting.robots}
    bases = {name: fleet.base(name) for name in names}
    return [
        FleetRobot(
            robot=name,
            works=robot.works,
            connected=fleet.is_connected(name),
            out_of_service=fleet.out_of_service.get(name),
            home=homes[name],
            run=fleet.run_of(name),
            pose=None if (base := bases[name]) is None else RobotPose.of(base),
            battery=fleet.battery(name),
            aboard=aboard[name],
            at_work=_at_work(name, fleet, dispatcher),
            stops=[_stop(*each) for each in stops[name]],
        )
        for name, robot in running.robots.items()
    ]


def _at_work(robot: str, fleet: "FleetAtWork", dispatcher: "Dispatcher") -> FleetLeg | None:
    leg = next((each for each in dispatcher.legs_under_way() if each.robot == robot), None)
    if leg is not None:
        return FleetLeg(place=leg.place, action=leg.action, request=leg.booking)
    errand = fleet.errands.get(robot)
    if errand is None:
        return None
    return FleetLeg(place=errand.place, action=None, request=None, charges=errand.charges)


def _stop(stop: "NextStop", action: LegAction) -> PlannedStop:
    return PlannedStop(
        place=stop.place,
        action=action,
        request=stop.item,
        begins_s=stop.begin_s,
        done_s=stop.done_s,
        slack_s=min(stop.slack_s, 1e9),
        partner=stop.partner,
    )
