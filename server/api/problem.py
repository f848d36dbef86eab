"""Why a request was refused (RFC 9457), as clients are told."""

from http import HTTPStatus
from typing import Any
from uuid import UUID

from pydantic import BaseModel, ConfigDict


class Problem(BaseModel):
    """Why a request was refused. `answered_by` on a lost race, `errors` one per mistake.

    `not_connected`: the robots that are to come before it can be done. `why`: what
    keeps a request from being met; `next_possible_s`: from when until when it could be.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    type: str = "about:blank"
    title: str
    status: int
    detail: str
    answered_by: str | None = None
    prompt: UUID | None = None
    errors: list[str] | None = None
    not_connected: list[str] | None = None
    why: str | None = None
    next_possible_s: list[float] | None = None


def problem(status: int, detail: str, **more: Any) -> Problem:
    return Problem(title=HTTPStatus(status).phrase, status=status, detail=detail, **more)
