"""Films of a run's cameras over REST: having one made."""

from typing import Annotated

from fastapi import APIRouter, Body
from pydantic import BaseModel, ConfigDict, Field

from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import HelperName, RunId, WithCaller, WithServices, helper_of
from mend.server.journal.events import RecordingBegun

router = APIRouter(prefix="/api/runs/{run}/recordings", tags=["runs"], route_class=RepeatableRoute)

LONGEST_S = 60.0
EXAMPLES = [{"seconds": 10, "helper": "anna"}]


class RecordingRequest(BaseModel):
    """For how long, in real time, and who says so; a principal's name is that of its token."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    seconds: Annotated[float, Field(ge=1, le=LONGEST_S, allow_inf_nan=False)]
    helper: HelperName | None = None


@router.post(
    "",
    operation_id="record_cameras",
    status_code=201,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422, 503),
)
async def record_cameras(
    run: RunId,
    body: Annotated[RecordingRequest, Body(examples=EXAMPLES)],
    services: WithServices,
    caller: WithCaller,
) -> RecordingBegun:
    """Record what all cameras of a run see from now on; its events name the pictures."""
    by = helper_of(caller, body.helper)
    return await services.runs.record(run, body.seconds, by, caller.author)
