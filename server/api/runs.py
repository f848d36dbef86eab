"""Runs over REST: start, watch, pause, resume, abort, and step into their worlds."""

from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Body, Path, Query, Response

from mend.documents.spellings import CAMERA
from mend.server.api.json_answer import json_answer
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import (
    After,
    Limit,
    Offset,
    RunId,
    SearchedText,
    Since,
    Until,
    WithCaller,
    WithServices,
)
from mend.server.journal.events import NO_RUN, AnyEvent
from mend.server.journal.run_index import RunPage
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunSummary, RunView
from mend.server.told_events import ToldEvents
from mend.server.turns import Turns
from mend.tasks.intervention import Intervention

DETECTION_HEADER = "Mend-Detection"

router = APIRouter(prefix="/api/runs", tags=["runs"], route_class=RepeatableRoute)

Statuses = Annotated[
    list[RunStatus] | None, Query(description="Only runs in one of these states; may be repeated.")
]
Before = Annotated[
    UUID | None, Query(description="Only runs that began before this one: the cursor of a page.")
]
Camera = Annotated[str, Path(pattern=CAMERA, examples=["head", "forearm"])]
RobotOfRun = Annotated[str | None, Query(max_length=128, description="Whose camera.")]

ToldQuery = Annotated[
    bool, Query(description="With `lines`: what the transcript tells of each event.")
]

RUN_EXAMPLES = [
    {"tree": "eket", "world": "workcell", "speed": 1.0, "seed": 7, "scenario": "eket_paper"},
    {"tree": "eket", "world": "tabletop", "speed": "max"},
]
STEAL_EXAMPLE = [{"act": "steal", "object": "pink_bar"}]

CHANGES = documented(401, 403, 404, 409, 421, 422, 503)


@router.post(
    "",
    operation_id="start_run",
    status_code=201,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422),
)
async def start_run(
    request: Annotated[RunRequest, Body(examples=RUN_EXAMPLES)],
    response: Response,
    services: WithServices,
    caller: WithCaller,
) -> RunSummary:
    """Begin a run of a task tree in a world."""
    run = await services.runs.start_run(request, caller.author)
    response.headers["Location"] = f"/api/runs/{run.id}"
    return run


@router.get("", operation_id="list_runs", responses=documented(401, 404, 421, 422))
async def list_runs(
    services: WithServices,
    limit: Limit = 100,
    offset: Offset = 0,
    status: Statuses = None,
    before: Before = None,
    text: SearchedText = None,
    tree: Annotated[str | None, Query(max_length=200)] = None,
    robot: Annotated[str | None, Query(max_length=200)] = None,
    since: Since = None,
    until: Until = None,
) -> list[RunSummary]:
    """Runs, newest first, for which all holds that is given.

    For the next page give the id of the last run as `before`: runs that begin meanwhile move no
    page, as they do with `offset`. A run that cannot be read is listed as `unreadable`.
    """
    return await services.runs.runs(
        RunPage(status, limit, offset, before, text, tree, robot, since, until)
    )


@router.get(
    "/{run}",
    operation_id="get_run",
    response_model=RunView,
    responses=documented(401, 404, 421, 422, 500),
)
async def get_run(run: RunId, services: WithServices) -> Response:
    """One run: status, every node's state, open dialogues, result."""
    return json_answer(*await services.runs.run_json(run))


@router.post("/{run}/pause", operation_id="pause_run", responses=CHANGES)
async def pause_run(run: RunId, services: WithServices, caller: WithCaller) -> RunSummary:
    """Stop the robots where they are, until the run is resumed."""
    return await services.runs.pause(run, caller.author)


@router.post("/{run}/resume", operation_id="resume_run", responses=CHANGES)
async def resume_run(run: RunId, services: WithServices, caller: WithCaller) -> RunSummary:
    """Go on with a paused run."""
    return await services.runs.resume(run, caller.author)


@router.post(
    "/{run}/abort",
    operation_id="abort_run",
    responses={
        202: {
            "model": RunSummary,
            "description": "Its robots stop; it has ended once that is kept.",
        },
        **CHANGES,
    },
)
async def abort_run(
    run: RunId, services: WithServices, caller: WithCaller, response: Response
) -> RunSummary:
    """End a run for good."""
    view = await services.runs.abort(run, caller.author)
    if not view.status.ended:
        response.status_code = 202
    return view


@router.get(
    "/{run}/events",
    operation_id="list_events",
    response_model=list[AnyEvent],
    responses=documented(401, 404, 421, 422, 500),
)
async def list_events(
    run: RunId,
    services: WithServices,
    after: After = 0,
    limit: Limit = 100,
    told: ToldQuery = False,
) -> Response:
    """A run's events in order; go on with the last `seq` as `after`, until a page is empty."""
    # What belongs to no run is for admins, at another door.
    if run == NO_RUN or await services.journal.index.find(run) is None:
        await services.runs.run_summary(run)
    records = await services.journal.read_records(after, limit, run)
    # The journal holds the very JSON that clients get.
    texts = [record.text for record in records]
    if told:
        telling, turns, texts = ToldEvents(services.journal.index), Turns(), []
        for record in records:
            texts.append(await telling.told(record))
            await turns.pass_on()
    body = "[" + ",".join(texts) + "]"
    return json_answer(body.encode())


@router.get(
    "/{run}/cameras/{camera}",
    operation_id="get_camera_picture",
    response_class=Response,
    responses={
        200: {
            "content": {"image/jpeg": {}},
            "description": "The picture.",
            "headers": {
                DETECTION_HEADER: {
                    "description": "While the robot looks for something: where in the picture "
                    "that is to be, as the JSON of a detection.",
                    "schema": {"type": "string"},
                }
            },
        },
        **documented(401, 404, 409, 421, 422),
    },
)
async def get_camera_picture(
    run: RunId, camera: Camera, services: WithServices, robot: RobotOfRun = None
) -> Response:
    """What a robot's camera sees now; the first that has such a camera, unless `robot` says."""
    picture = await services.runs.picture(run, camera, robot)
    headers = {"Cache-Control": "no-store"}
    if picture.detection is not None:
        headers[DETECTION_HEADER] = picture.detection.model_dump_json(ensure_ascii=True)
    return Response(picture.jpeg, media_type="image/jpeg", headers=headers)


@router.post(
    "/{run}/interventions",
    operation_id="intervene",
    status_code=201,
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422),
)
async def intervene(
    run: RunId,
    intervention: Annotated[Intervention, Body(examples=STEAL_EXAMPLE)],
    services: WithServices,
    caller: WithCaller,
) -> Intervention:
    """Have a person do something in a simulated world."""
    await services.runs.intervene(run, intervention, caller.author)
    return intervention
