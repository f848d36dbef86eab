"""The fleet of a site over REST: what its robots are at, and what operators have them do."""

import math
from functools import partial
from typing import Annotated

from fastapi import APIRouter, Body, Path, Response

from mend.server.api.poses import FRAMES, MOST_FRAMES, MostFrames, Seconds, frames_answer
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import SiteId, WithCaller, WithServices
from mend.server.fleets.asking import AskedRobotView, asked_robot
from mend.server.fleets.operator_requests import GoThere, OutOfService, WayReport
from mend.server.fleets.views import FleetView

router = APIRouter(prefix="/api/sites/{site}/fleet", tags=["requests"], route_class=RepeatableRoute)

FleetRobotName = Annotated[str, Path(max_length=128, description="The robot's name.")]


@router.get(
    "",
    operation_id="get_fleet",
    responses=documented(401, 404, 409, 421, 422),
)
async def get_fleet(site: SiteId, services: WithServices) -> FleetView:
    """What the robots of a site are still to do, and why their plan has become what it is."""
    fleet = await services.fleets.fleet(site)
    return await fleet.read(partial(FleetView.of, fleet))


@router.get(
    "/poses",
    operation_id="get_fleet_poses",
    response_class=Response,
    responses=FRAMES | documented(401, 404, 409, 421, 422, 500),
)
async def get_fleet_poses(
    site: SiteId,
    services: WithServices,
    from_s: Seconds = 0.0,
    to_s: Seconds | None = None,
    limit: MostFrames = MOST_FRAMES,
) -> Response:
    """Where its robots were in a span of the site's clock, in the order of `get_fleet`."""
    await services.fleets.fleet(site)
    until_s = math.inf if to_s is None else to_s
    return frames_answer(await services.poses.recorded(site, from_s, until_s, limit))


@router.get(
    "/robots/{robot}/asking",
    operation_id="get_asked_robot",
    responses=documented(401, 404, 409, 421, 422),
)
async def get_asked_robot(
    site: SiteId, robot: FleetRobotName, services: WithServices
) -> AskedRobotView:
    """Where a robot is and what may be asked of it, for whoever stands at its touch screen."""
    return asked_robot(await services.fleets.fleet(site), robot)


@router.post(
    "/robots/{robot}/out_of_service",
    operation_id="take_robot_out",
    status_code=204,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def take_robot_out(
    site: SiteId,
    robot: FleetRobotName,
    why: Annotated[OutOfService, Body(examples=[{"reason": "its wheel squeaks"}])],
    services: WithServices,
    caller: WithCaller,
) -> None:
    """Have a robot break off what it does and do nothing more; others fetch what it has."""
    await (await services.fleets.fleet(site)).operators.take_out(robot, why.reason, caller.author)


@router.post(
    "/robots/{robot}/back_in_service",
    operation_id="put_robot_back",
    status_code=204,
    responses=documented(401, 403, 404, 409, 421, 422, 503),
)
async def put_robot_back(
    site: SiteId, robot: FleetRobotName, services: WithServices, caller: WithCaller
) -> None:
    """Have a robot work again, from where it stands."""
    await (await services.fleets.fleet(site)).operators.put_back(robot, caller.author)


@router.post(
    "/robots/{robot}/go",
    operation_id="send_robot",
    status_code=204,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def send_robot(
    site: SiteId,
    robot: FleetRobotName,
    to: Annotated[GoThere, Body(examples=[{"place": "F1/101"}])],
    services: WithServices,
    caller: WithCaller,
) -> None:
    """Have a robot that is at no leg go to a place; refused while it is, or is not there."""
    await (await services.fleets.fleet(site)).operators.send(robot, to.place, caller.author)


@router.post(
    "/ways",
    operation_id="tell_of_way",
    status_code=204,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def tell_of_way(
    site: SiteId,
    found: Annotated[
        WayReport, Body(examples=[{"finding": "blocked", "between": ["F1/hall", "F1/lift"]}])
    ],
    services: WithServices,
    caller: WithCaller,
) -> None:
    """Say that a way between neighbouring places is blocked, a door closed, or open again."""
    await (await services.fleets.fleet(site)).operators.found(found, caller.author)
