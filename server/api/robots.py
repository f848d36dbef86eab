"""Robots over REST: which there are, and how one fetches its own credential."""

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict, Field

from mend.server.access.access import address_of
from mend.server.access.changes import EnrolmentRefusedError
from mend.server.access.principals_file import RobotName
from mend.server.access.roles import Role
from mend.server.api.principals import edited
from mend.server.api.problems import ProblemError, documented
from mend.server.api.repeatable import SecretRoute
from mend.server.api.services import Limit, Offset, WithServices
from mend.server.journal.events import Author
from mend.server.runtime.views import RobotView

router = APIRouter(prefix="/api/robots", tags=["robots"], route_class=SecretRoute)


class EnrolmentRequest(BaseModel):
    """Which robot it is, and the code that an admin has made for it."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    robot: RobotName = Field(examples=["arm-1"])
    code: str = Field(max_length=100, examples=["ABCD-EFGH-IJKL-MNOP-QRST-UVWX"])


class Credential(BaseModel):
    """A robot's own credential: its bearer token on `/ws/robot`, good for this name alone."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    robot: str
    token: str


@router.get("", operation_id="list_robots", responses=documented(401, 403, 421, 422))
async def list_robots(
    services: WithServices, limit: Limit = 1000, offset: Offset = 0
) -> list[RobotView]:
    """Every robot that is connected or known, with its state."""
    return services.runs.robots()[offset : offset + limit]


@router.post(
    "/enrol", operation_id="enrol_robot", status_code=201,
    responses=documented(400, 403, 409, 413, 421, 422, 429, 503),
)  # fmt: skip
async def enrol_robot(
    body: EnrolmentRequest, request: Request, services: WithServices
) -> Credential:
    """Exchange a one-time code for the robot's own credential, which is shown only now."""
    address = address_of(request)
    waiting = services.access.waiting(body.code, request)
    if waiting.wait_s:
        raise ProblemError(429, waiting.too_many, waiting.retry_after)
    try:
        token = await edited(
            services,
            Author(principal=body.robot, role=Role.ROBOT, address=address),
            lambda editor: editor.enrol(body.robot, body.code, services.utc_now()),
        )
    except EnrolmentRefusedError:
        services.access.wrong(body.code, request)
        raise
    return Credential(robot=body.robot, token=token)
