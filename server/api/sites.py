"""Sites over REST: open and close simulated worlds that stay, and see who has their robots."""

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Body, Response

from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import After, Limit, Offset, SiteId, WithCaller, WithServices
from mend.server.journal.events import AnyEvent, Event
from mend.server.sites.requests import SiteRequest
from mend.server.sites.views import SiteView

router = APIRouter(prefix="/api/sites", tags=["sites"], route_class=RepeatableRoute)

SITE_EXAMPLES = [
    {"scene": "kit", "world": "tabletop", "speed": 1.0, "seed": 7},
    {"scene": "eket", "world": "workcell", "speed": "max"},
]


@router.post(
    "",
    operation_id="open_site",
    status_code=201,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def open_site(
    request: Annotated[SiteRequest, Body(examples=SITE_EXAMPLES)],
    response: Response,
    services: WithServices,
    caller: WithCaller,
) -> SiteView:
    """Start a simulated world that stays, with its robots, until it is closed."""
    site = await services.sites.open_site(request, caller.author)
    response.headers["Location"] = f"/api/sites/{site.id}"
    return site


@router.get("", operation_id="list_sites", responses=documented(401, 421, 422))
async def list_sites(
    services: WithServices, limit: Limit = 1000, offset: Offset = 0
) -> list[SiteView]:
    """Every open site with its robots, in the order in which they were opened."""
    return services.sites.sites()[offset : offset + limit]


@router.get("/{site}", operation_id="get_site", responses=documented(401, 404, 421, 422))
async def get_site(site: SiteId, services: WithServices) -> SiteView:
    """One site, its robots, and the runs that have them."""
    return services.sites.view(site)


@router.delete(
    "/{site}",
    operation_id="close_site",
    status_code=204,
    responses=documented(401, 403, 404, 409, 421, 422, 503),
)
async def close_site(site: SiteId, services: WithServices, caller: WithCaller) -> None:
    """Stop a site's world for good; no run may be using it."""
    await services.fleets.close_site(site)
    await services.sites.close_site(site, caller.author)


@router.get(
    "/{site}/events",
    operation_id="list_site_events",
    response_model=list[AnyEvent],
    responses=documented(401, 404, 421, 422, 500),
)
async def list_site_events(
    site: SiteId, services: WithServices, after: After = 0, limit: Limit = 100
) -> Sequence[Event]:
    """What became of a site, in order, also of a closed one; go on with the last `seq`."""
    return await services.sites.events(site, after, limit)
