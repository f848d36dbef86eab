"""Requests over REST: what people of a building want of its robots, and how far that has come."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated
from uuid import UUID

from fastapi import APIRouter, Body, Path, Query, Response

from mend.fleet.requests import Request, RequestStatus
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import Limit, Offset, Services, WithCaller, WithServices
from mend.server.fleets.asking import UnderstoodView, WordsAsked, understand
from mend.server.fleets.views import RequestView
from mend.server.fleets.waiting_robots import followed, waiting_robots

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import RequestView as Booked

router = APIRouter(tags=["requests"], route_class=RepeatableRoute)

EXAMPLES = [
    {"kind": "transport", "name": "parcel", "what": "the blue parcel", "origin": "F1/101",
     "destination": "F2/203"},
    {"kind": "deliver_message", "name": "lunch", "place": "F1/102", "message": "Lunch is ready."},
]  # fmt: skip
WORDS = [{"words": "bring this to room 203 by three o'clock", "robot": "robot1", "clock": "14:20"}]
MOST_OPEN = 1000
"""Every dialogue that is open: a robot has one at a time."""
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
    wanted = [each for each in found if status in (None, each[1].status)]
    return await _followed(wanted[offset : offset + limit], services)


@router.get(
    "/api/requests/{name:path}",
    operation_id="get_request",
    responses=documented(401, 404, 409, 421, 422),
)
async def get_request(
    name: RequestPath, services: WithServices, site: AtSite = None
) -> RequestView:
    """How far one request has come, when it is expected, and what its robot waits for."""
    (view,) = await _followed([await services.fleets.request(site, name)], services)
    return view


async def _followed(
    found: "Sequence[tuple[UUID, Booked]]", services: Services
) -> list[RequestView]:
    waiting = waiting_robots(await services.runs.dialogues.page("open", MOST_OPEN, 0))
    fleets = {at: await services.fleets.fleet(at) for at in {at for at, _ in found}}
    return [followed(at, booked, fleets[at].run_of, waiting) for at, booked in found]


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
    """Ask for something else instead, as long as no robot has set out; refused, all stays.

    One occurrence of what recurs keeps its time where none is given.
    """
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
