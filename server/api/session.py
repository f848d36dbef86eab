"""How a browser signs in: the token once, a cookie from then on."""

import math

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from mend.server.access.access import SESSION_COOKIE, address_of
from mend.server.access.principal import Caller
from mend.server.access.roles import Role
from mend.server.access.sessions import SESSION_LIFETIME_S, TooManySessionsError
from mend.server.api.problems import ProblemError, documented
from mend.server.api.repeatable import SecretRoute
from mend.server.api.services import WithCallerIfKnown, WithServices
from mend.server.journal.journal import JournalWriteError

router = APIRouter(prefix="/api", tags=["session"], route_class=SecretRoute)


class SignIn(BaseModel):
    """The token of a principal, or the service's own."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    token: str = Field(max_length=1024, examples=["a-long-random-token"])


class SessionView(BaseModel):
    """Whether a token is needed, whether this client has shown one, and whose it is.

    `name` None: whoever it is says what they are called. `role` None: a stranger.
    """

    model_config = ConfigDict(frozen=True)

    required: bool
    signed_in: bool
    name: str | None
    role: Role | None


@router.get("/session", operation_id="get_session", responses=documented(421))
async def get_session(caller: WithCallerIfKnown, services: WithServices) -> SessionView:
    """Whether a token is needed, whether this client has shown one, and whose it is."""
    principal = None if caller is None else caller.principal
    return SessionView(
        required=services.access.required,
        signed_in=principal is not None,
        name=principal.name if principal is not None and principal.named else None,
        role=None if principal is None else principal.role,
    )


@router.post(
    "/session", operation_id="sign_in", status_code=204,
    responses=documented(400, 401, 403, 413, 421, 422, 429, 503),
)  # fmt: skip
async def sign_in(
    body: SignIn, request: Request, response: Response, services: WithServices
) -> None:
    """Show a token and get a session cookie for it; a session that was there before ends."""
    admission = services.access.by_token(body.token, request)
    if admission.wait_s:
        raise ProblemError(429, admission.too_many, admission.retry_after)
    if admission.caller is None:
        raise ProblemError(
            401, "this is not the token of anybody here", {"WWW-Authenticate": "Bearer"}
        )
    principal = admission.caller.principal
    if principal.role is Role.ROBOT:
        raise ProblemError(403, "this is the credential of a robot, and no person's token")
    try:
        _, cookie = services.access.sessions.new(principal)
    except TooManySessionsError as error:
        later = {"Retry-After": f"{math.ceil(error.wait_s)}"}
        raise ProblemError(429, str(error), later, limit="sign_ins") from error
    await _end_session(request, services)
    services.deeds.signed_in(principal, address_of(request))
    response.set_cookie(
        SESSION_COOKIE,
        cookie,
        max_age=SESSION_LIFETIME_S,
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
    )


@router.delete(
    "/session", operation_id="sign_out", status_code=204, responses=documented(403, 421, 503)
)
async def sign_out(request: Request, response: Response, services: WithServices) -> None:
    """End the session: its cookie opens nothing any more, wherever else it may be.

    While the journal cannot be written that is refused (503), and the session lasts.
    """
    await _end_session(request, services)
    response.delete_cookie(SESSION_COOKIE, httponly=True, samesite="strict")


async def _end_session(request: Request, services: WithServices) -> None:
    session = services.access.session(request)
    if session is None:
        return
    principal = services.access.of_session(session)
    assert principal is not None, "a good session is somebody's"
    caller = Caller(principal, address_of(request), session.id)

    def end() -> None:
        services.access.sessions.end(session.id, session.expires)
        services.access.let_go()

    try:
        await services.deeds.signed_out(session, caller, end)
    except JournalWriteError as error:
        raise ProblemError(503, f"the session lasts, as it cannot be ended now: {error}") from error
