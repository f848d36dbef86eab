"""Recorded poses of runs, for replay."""

import math
from typing import Annotated, Any

from fastapi import APIRouter, Query, Response

from mend.errors import NotFoundError
from mend.server.api.problems import documented
from mend.server.api.services import RunId, WithServices
from mend.server.poses.frame import framed
from mend.server.poses.layout import Layout
from mend.server.poses.record import RecordedPoses

router = APIRouter(prefix="/api/runs", tags=["runs"])

SPAN_HEADER = "Mend-Poses-Span"
MOST_FRAMES = 20_000

FRAMES: dict[int | str, dict[str, Any]] = {
    200: {
        "content": {"application/octet-stream": {}},
        "description": "Frames, each after its length in bytes (uint32, little endian).",
        "headers": {
            SPAN_HEADER: {
                "description": "The first and the last time of which anything is recorded.",
                "schema": {"type": "string"},
            }
        },
    }
}
"""What an answer of frames is, as documented."""

MostFrames = Annotated[int, Query(ge=1, le=MOST_FRAMES)]
Seconds = Annotated[float, Query(ge=0.0, le=1e9, allow_inf_nan=False)]


@router.get(
    "/{run}/layout", operation_id="get_layout", responses=documented(401, 404, 421, 422, 500)
)
async def get_layout(run: RunId, services: WithServices) -> Layout:
    """What the frames of a run hold, in order, and what does not move in it."""
    await services.runs.run_summary(run)
    layout = await services.poses.layout(run)
    if layout is None:
        raise NotFoundError(f"the robot of run {run} has not shown where anything is")
    return layout


@router.get(
    "/{run}/poses",
    operation_id="get_poses",
    response_class=Response,
    responses=FRAMES | documented(401, 404, 421, 422, 500),
)
async def get_poses(
    run: RunId,
    services: WithServices,
    from_s: Seconds = 0.0,
    to_s: Seconds | None = None,
    limit: MostFrames = MOST_FRAMES,
) -> Response:
    """The recorded frames of a span of the run's clock, evenly thinned out to `limit`."""
    await services.runs.run_summary(run)
    until_s = math.inf if to_s is None else to_s
    return frames_answer(await services.poses.recorded(run, from_s, until_s, limit))


def frames_answer(recorded: RecordedPoses) -> Response:
    """Recorded frames as an answer."""
    headers = {"Cache-Control": "no-store"}
    if recorded.span_s is not None:
        headers[SPAN_HEADER] = " ".join(f"{each:.3f}" for each in recorded.span_s)
    return Response(framed(recorded.frames), media_type="application/octet-stream", headers=headers)
