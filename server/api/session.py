"""How a browser signs in: the token once, a cookie from then on."""

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from server.api.access import SESSION_COOKIE, SESSION_LIFETIME_S
from server.api.parts import WithParts
from server.api.problems import ProblemError, documented

router = APIRouter(prefix="/api", tags=["session"])


class SignIn(BaseModel):
    """The service's token."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    token: str = Field(max_length=1024, examples=["a-long-random-token"])


class SessionView(BaseModel):
    """Whether a token is needed, and whether this client has shown it."""

    model_config = ConfigDict(frozen=True)

    required: bool
    signed_in: bool


@router.get("/session", operation_id="get_session", responses=documented(421))
async def get_session(request: Request, parts: WithParts) -> SessionView:
    """Whether a token is needed, and whether this client has shown it."""
    admitted = parts.access.by_request(request).admitted
    return SessionView(required=parts.access.required, signed_in=admitted)


@router.post(
    "/session", operation_id="sign_in", status_code=204,
    responses=documented(400, 401, 403, 413, 421, 422),
)  # fmt: skip
async def sign_in(body: SignIn, request: Request, response: Response, parts: WithParts) -> None:
    """Show the token and get a session cookie for it."""
    admission = parts.access.by_token(body.token, request)
    if admission.wait_s:
        raise ProblemError(429, admission.too_many, admission.retry_after)
    if not admission.admitted:
        raise ProblemError(401, "this is not the token", {"WWW-Authenticate": "Bearer"})
    response.set_cookie(
        SESSION_COOKIE,
        parts.access.new_session(),
        max_age=SESSION_LIFETIME_S,
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
    )


@router.delete("/session", operation_id="sign_out", status_code=204, responses=documented(403, 421))
async def sign_out(response: Response) -> None:
    """Forget the session cookie."""
    response.delete_cookie(SESSION_COOKIE, httponly=True, samesite="strict")
