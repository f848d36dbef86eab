"""Problem documents (RFC 9457): how every refusal looks on the wire."""

import json
import logging
from collections.abc import Callable, Mapping
from http import HTTPStatus
from typing import Any, cast

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from mend.errors import (
    ConflictError,
    MendError,
    NotFoundError,
    RefusalError,
    UnavailableError,
    UnreadableError,
    WrongInputError,
)
from mend.server.access.changes import EnrolmentRefusedError
from mend.server.access.deed_log import ToldLaterError
from mend.server.access.principals_file import PrincipalsFileError
from mend.server.access.roles import Role, with_article
from mend.server.api.mistakes import MOST_TOLD, validation_sentences
from mend.server.api.problem import Problem, problem
from mend.server.api.safe_headers import SAFE_HEADERS
from mend.server.api.services import services_of
from mend.server.descriptors import NO_DESCRIPTOR
from mend.server.errors import BusyError, LostRaceError, NotConnectedError
from mend.server.fleets.request_refused import RequestRefusedError
from mend.server.journal.journal import JournalClosedError, JournalReadError, JournalWriteError
from mend.server.limits import LimitName
from mend.server.refusals import Refusals

log = logging.getLogger(__name__)

MEDIA_TYPE = "application/problem+json"

STATUSES: tuple[tuple[type[Exception], int], ...] = (
    (EnrolmentRefusedError, 403),
    (NotFoundError, 404),
    (ConflictError, 409),
    (WrongInputError, 422),
    (UnreadableError, 500),
    (UnavailableError, 503),
    (JournalReadError, 500),
    (PrincipalsFileError, 503),
    (JournalWriteError, 503),
    (JournalClosedError, 503),
)


SOON = {"Retry-After": "1"}
"""What may be possible again after a second, where nothing more is known."""


class ProblemError(MendError):
    """A refusal that the API itself decides on; `limit` is the one that was reached, if any."""

    def __init__(
        self,
        status: int,
        detail: str,
        headers: Mapping[str, str] | None = None,
        *,
        limit: LimitName | None = None,
    ) -> None:
        super().__init__(detail)
        self.status = status
        self.headers = headers
        self.limit = limit


def forbidden(needed: Role, role: Role) -> Problem:
    """What somebody reads who may not do something."""
    return problem(403, f"this needs the role '{needed}'; you are {with_article(role)}")


def problem_of(error: Exception) -> Problem | None:
    """The problem that an error of the service stands for; None if it is a defect."""
    status = next((status for kind, status in STATUSES if isinstance(error, kind)), None)
    if status is None:
        return None
    if isinstance(error, LostRaceError):
        return problem(status, str(error), answered_by=error.answered_by, prompt=error.prompt)
    if isinstance(error, NotConnectedError):
        return problem(status, str(error), not_connected=error.robots)
    if isinstance(error, RequestRefusedError):
        return problem(status, str(error), why=error.why, next_possible_s=error.next_possible_s)
    if isinstance(error, WrongInputError):
        return problem(status, str(error), errors=error.sentences or [str(error)])
    return problem(status, str(error))


def count_refusal(error: Exception, refusals: Refusals) -> None:
    """Count what was refused because a limit was reached."""
    if isinstance(error, RefusalError | ProblemError) and error.limit is not None:
        refusals.note(cast(LimitName, error.limit))


def problem_text(refusal: Problem) -> bytes:
    """The document itself."""
    # What a client sent may come back in a message, lone surrogates included.
    text = json.dumps(refusal.model_dump(mode="json", exclude_none=True), ensure_ascii=False)
    return text.encode("utf-8", "replace")


def problem_response(refusal: Problem, headers: Mapping[str, str] | None = None) -> Response:
    """The document as an answer; one of a defect does not go through the gate."""
    return Response(
        problem_text(refusal),
        refusal.status,
        media_type=MEDIA_TYPE,
        headers={**SAFE_HEADERS, **(headers or {})},
    )


def documented(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The refusals of an operation, for its OpenAPI description."""
    content = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    return {
        status: {"description": HTTPStatus(status).phrase, "content": content}
        for status in sorted(statuses)
    }


def answer_errors_with_problems(
    app: FastAPI, page_of_nothing: Callable[[Request], Response | None]
) -> None:
    """Make every error of an application a problem document.

    Of an address where there is nothing it may be a page instead, for those who look for pages.
    """

    async def _http_error(request: Request, error: Exception) -> Response:
        assert isinstance(error, HTTPException)
        page = page_of_nothing(request) if error.status_code == 404 else None
        return page or _http_problem(request, error)

    app.add_exception_handler(HTTPException, _http_error)
    app.add_exception_handler(RequestValidationError, _validation_error)
    app.add_exception_handler(ProblemError, _problem_error)
    app.add_exception_handler(OSError, _no_descriptor)
    app.add_exception_handler(MendError, _mend_error)
    app.add_exception_handler(Exception, _defect)


def _http_problem(request: Request, error: HTTPException) -> Response:
    details = {
        404: f"there is nothing at {request.url.path}",
        405: f"{request.method} is not possible at {request.url.path}",
    }
    detail = details.get(error.status_code, str(error.detail))
    return problem_response(problem(error.status_code, detail), error.headers)


async def _validation_error(_request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    sentences = validation_sentences(error.errors(), error.body)
    count = f"more than {MOST_TOLD}" if len(sentences) > MOST_TOLD else f"{len(sentences)}"
    detail = sentences[0] if len(sentences) == 1 else f"{count} things are wrong"
    return problem_response(problem(422, detail, errors=sentences))


async def _problem_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, ProblemError)
    count_refusal(error, services_of(request).refusals)
    return problem_response(problem(error.status, str(error)), error.headers)


async def _mend_error(request: Request, error: Exception) -> Response:
    refusal = problem_of(error)
    if refusal is None:
        return await _defect(request, error)
    count_refusal(error, services_of(request).refusals)
    return problem_response(refusal, _retry_after(error))


def _retry_after(error: Exception) -> Mapping[str, str] | None:
    """When to ask again; None where that would do something twice, or nothing."""
    if isinstance(error, BusyError):
        return {"Retry-After": f"{error.retry_after_s}"}
    undone = isinstance(error, JournalWriteError | JournalClosedError | JournalReadError)
    return SOON if undone and not isinstance(error, ToldLaterError) else None


async def _no_descriptor(_request: Request, error: Exception) -> Response:
    """Without descriptors no request can be served; there is nothing in that to look into."""
    assert isinstance(error, OSError)
    if error.errno not in NO_DESCRIPTOR:
        raise error
    detail = "the service has too many files and connections open just now; try again"
    return problem_response(problem(503, detail), SOON)


async def _defect(request: Request, error: Exception) -> Response:
    log.error("%s %s failed", request.method, request.url.path, exc_info=error)
    return problem_response(problem(500, "the service made a mistake; its log says more"))
