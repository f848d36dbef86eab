"""Steering of runs over REST: where they wait, what is next, what may be said of a node."""

from typing import Annotated

from fastapi import APIRouter, Body, Query
from pydantic import Discriminator, Tag

from mend.documents.spellings import NODE
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import HelperName, RunId, WithCaller, WithServices, helper_of
from mend.server.runtime.steering_views import (
    NodeSteeringView,
    SetAutonomy,
    SteeringView,
    SteerNode,
)

router = APIRouter(prefix="/api/runs/{run}/steering", tags=["runs"], route_class=RepeatableRoute)

EXAMPLES = [
    {"act": "set_breakpoint", "node": "/0/1", "reason": "the glue is still wet", "helper": "anna"},
    {"act": "set_autonomy", "level": "low", "helper": "anna"},
]


class SteerNodeRequest(SteerNode):
    """What is to be of a node, and who says so; a principal's name is that of its token."""

    helper: HelperName | None = None


class SetAutonomyRequest(SetAutonomy):
    """How much the robots may do without being asked, and who says so."""

    helper: HelperName | None = None


def _kind(body: object) -> str:
    act = body.get("act") if isinstance(body, dict) else getattr(body, "act", None)
    return "run" if act == "set_autonomy" else "node"


SteeringRequest = Annotated[
    Annotated[SteerNodeRequest, Tag("node")] | Annotated[SetAutonomyRequest, Tag("run")],
    Discriminator(_kind),
]
OfNode = Annotated[str, Query(pattern=NODE, max_length=400, examples=["/0/1"])]


@router.get("", operation_id="get_steering", responses=documented(401, 404, 421, 422, 500))
async def get_steering(run: RunId, services: WithServices) -> SteeringView:
    """How a run is steered: breakpoints, what is next, its autonomy, and what waits."""
    return await services.runs.steering(run)


@router.get(
    "/offers", operation_id="get_steering_offers", responses=documented(401, 404, 409, 421, 422)
)
async def get_steering_offers(run: RunId, services: WithServices, node: OfNode) -> NodeSteeringView:
    """What would be taken of a node now, with what comes of it, and why the rest would not."""
    return await services.runs.steering_of(run, node)


@router.post(
    "",
    operation_id="steer_run",
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def steer_run(
    run: RunId,
    body: Annotated[SteeringRequest, Body(examples=EXAMPLES)],
    services: WithServices,
    caller: WithCaller,
) -> SteeringView:
    """Steer a run; refused with a sentence where that would break the order of its tree."""
    by = helper_of(caller, body.helper)
    return await services.runs.steer(run, body, by, caller.author)
