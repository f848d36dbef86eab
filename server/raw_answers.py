"""Answers to requests that the application never sees, as bytes."""

from http import HTTPStatus

from mend.server.api.problem import problem
from mend.server.api.problems import MEDIA_TYPE, problem_text
from mend.server.api.safe_headers import SAFE_HEADERS


def raw_problem(status: HTTPStatus, detail: str, *, retry_after_s: int | None = None) -> bytes:
    """A whole HTTP/1.1 answer: a problem document, after which the connection is closed."""
    body = problem_text(problem(status, detail))
    headers = {
        "Content-Type": MEDIA_TYPE,
        "Content-Length": str(len(body)),
        "Connection": "close",
        **SAFE_HEADERS,
    }
    if retry_after_s is not None:
        headers["Retry-After"] = str(retry_after_s)
    lines = [f"HTTP/1.1 {status.value} {status.phrase}"]
    lines += [f"{name}: {value}" for name, value in headers.items()]
    return "\r\n".join([*lines, "", ""]).encode() + body
