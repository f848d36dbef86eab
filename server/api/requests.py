"""Requests over REST: what people of a building want of its robots, and how far that has come."""

from functools import partial
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Body, Path, Query, Response

from mend.fleet.requests import Request, RequestStatus
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import Limit, Offset, SiteId, WithCaller, WithServices
from mend.server.fleets.asking import (
    AskedRobotView,
    UnderstoodView,
    WordsAsked,
    asked_robot,
    understand,
)
from mend.server.fleets.operator_requests import GoThere, OutOfService, WayReport
from mend.server.fleets.views import FleetView, RequestView

router = APIRouter(tags=["requests"], route_class=RepeatableRoute)

EXAMPLES = [
    {"kind": "transport", "name": "parcel", "what": "the blue parcel", "origin": "F1/101",
     "destination": "F2/203"},
    {"kind": "deliver_message", "name": "lunch", "place": "F1/102", "message": "Lunch is ready."},
]  # fmt: skip
WORDS = [{"words": "bring this to room 203 by three o'clock", "robot": "robot1", "clock": "14:20"}]
AtSite = Annotated[
    UUID | None, Query(description="The site whose robots are meant, where several take requests.")
]
# Occurrences of what recurs are called as it and their number: daily/3.
RequestPath = Annotated[
    str, Path(min_length=1, max_length=80, description="The request's name.", examples=["parcel"])
]
WithRequest = Annotated[Request, Body(examples=EXAMPLES)]


@router.post(
    "/api/requests",
    operation_id="make_request",
    status_code=201,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def make_request(
    request: WithRequest,
    response: Response,
    services: WithServices,
    caller: WithCaller,
    site: AtSite = None,
) -> RequestView:
    """Ask robots of a building for something; refused is what they cannot do in time."""
    at, booked = await services.fleets.submit(site, request, caller.author)
    response.headers["Location"] = f"/api/requests/{booked.name}?site={at}"
    return RequestView.of(at, booked)


@router.post(
    "/api/requests/understand",
    operation_id="understand_request",
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422),
)
async def understand_request(
    asked: Annotated[WordsAsked, Body(examples=WORDS)], services: WithServices, site: AtSite = None
) -> UnderstoodView:
    """What somebody asks for in plain English, to be read back to them before it is asked for."""
    return await understand(await services.fleets.fleet(site), asked)


@router.get("/api/requests", operation_id="list_requests", responses=documented(401, 404, 421, 422))
async def list_requests(
    services: WithServices,
    site: AtSite = None,
    status: RequestStatus | None = None,
    limit: Limit = 1000,
    offset: Offset = 0,
) -> list[RequestView]:
    """All requests that are open, and the last ones that are over, in the order they came."""
    found = await services.fleets.requests(site)
    views = [RequestView.of(*each) for each in found if status in (None, each[1].status)]
    return views[offset : offset + limit]


@router.get(
    "/api/requests/{name:path}",
    operation_id="get_request",
    responses=documented(401, 404, 409, 421, 422),
)
async def get_request(
    name: RequestPath, services: WithServices, site: AtSite = None
) -> RequestView:
    """How far one request has come, and when it is expected to be done."""
    return RequestView.of(*await services.fleets.request(site, name))


@router.put(
    "/api/requests/{name:path}",
    operation_id="change_request",
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def change_request(
    name: RequestPath,
    request: WithRequest,
    services: WithServices,
    caller: WithCaller,
    site: AtSite = None,
) -> RequestView:
    """Ask for something else instead, as long as no robot has set out; refused, all stays."""
    return RequestView.of(*await services.fleets.change(site, name, request, caller.author))


@router.delete(
    "/api/requests/{name:path}",
    operation_id="cancel_request",
    status_code=204,
    responses=documented(401, 403, 404, 409, 421, 422, 503),
)
async def cancel_request(
    name: RequestPath, services: WithServices, caller: WithCaller, site: AtSite = None
) -> None:
    """Want it no more; what is fetched goes back to where it came from."""
    await services.fleets.cancel(site, name, caller.author)


@router.get(
    "/api/sites/{site}/fleet",
    operation_id="get_fleet",
    responses=documented(401, 404, 409, 421, 422),
)
async def get_fleet(site: SiteId, services: WithServices) -> FleetView:
    """What the robots of a site are still to do, and why their plan has become what it is."""
    fleet = await services.fleets.fleet(site)
    return await fleet.read(partial(FleetView.of, fleet))


FleetRobotName = Annotated[str, Path(max_length=128, description="The robot's name.")]


@router.get(
    "/api/sites/{site}/fleet/robots/{robot}/asking",
    operation_id="get_asked_robot",
    responses=documented(401, 404, 409, 421, 422),
)
async def get_asked_robot(
    site: SiteId, robot: FleetRobotName, services: WithServices
) -> AskedRobotView:
    """Where a robot is and what may be asked of it, for whoever stands at its touch screen."""
    return asked_robot(await services.fleets.fleet(site), robot)


@router.post(
    "/api/sites/{site}/fleet/robots/{robot}/out_of_service",
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
    await (await services.fleets.fleet(site)).take_out(robot, why.reason, caller.author)


@router.post(
    "/api/sites/{site}/fleet/robots/{robot}/back_in_service",
    operation_id="put_robot_back",
    status_code=204,
    responses=documented(401, 403, 404, 409, 421, 422, 503),
)
async def put_robot_back(
    site: SiteId, robot: FleetRobotName, services: WithServices, caller: WithCaller
) -> None:
    """Have a robot work again, from where it stands."""
    await (await services.fleets.fleet(site)).put_back(robot, caller.author)


@router.post(
    "/api/sites/{site}/fleet/robots/{robot}/go",
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
    await (await services.fleets.fleet(site)).send(robot, to.place, caller.author)


@router.post(
    "/api/sites/{site}/fleet/ways",
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
    await (await services.fleets.fleet(site)).found(found, caller.author)
