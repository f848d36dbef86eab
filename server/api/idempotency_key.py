"""The header `Idempotency-Key`: what stands in it, and what the API says of it."""

import re
from typing import Any

from starlette.requests import HTTPConnection

from mend.server.api.idempotency_header import HEADER
from mend.server.api.problems import ProblemError, documented

REPLAYED = "Idempotency-Replayed"
"""Says with an answer that it is the first one again."""

LONGEST = 255

STRING = re.compile(r'"((?:[\x20-\x21\x23-\x5b\x5d-\x7e]|\\["\\])*)"')
"""A string as a structured field (RFC 8941) has it, which the draft of the header asks for."""

BARE = re.compile(r"[A-Za-z0-9._~:+/=@-]+")
"""Without quotation marks, as many clients send it."""

PARAMETER: dict[str, Any] = {
    "name": HEADER,
    "in": "header",
    "required": False,
    "description": "Under the same key the same request is done once, and is given its first "
    "answer again. A string in quotation marks, unlike for every request, as a UUID.",
    "schema": {"type": "string", "minLength": 1, "maxLength": LONGEST},
    "example": '"8e03978e-40d5-43e8-bc93-6894a57f9324"',
}
"""The header as a parameter in the OpenAPI."""

RESPONSE_HEADER: dict[str, Any] = {
    REPLAYED: {
        "description": "`true` where this is the first answer to the request, given again.",
        "schema": {"type": "string", "enum": ["true"]},
    }
}


def take_keys(schema: dict[str, Any]) -> None:
    """Say of every POST in an OpenAPI that it takes a key, and what becomes of that."""
    for path in schema["paths"].values():
        if "post" not in path:
            continue
        operation = path["post"]
        operation.setdefault("parameters", []).append(PARAMETER)
        for status, answer in operation["responses"].items():
            if status.startswith("2"):
                answer.setdefault("headers", {}).update(RESPONSE_HEADER)
        for status, answer in documented(400, 409, 422).items():
            operation["responses"].setdefault(str(status), answer)


def key_in(connection: HTTPConnection) -> str | None:
    """The key that a request comes under; None without one.

    Raises `ProblemError` (400) for what is no key.
    """
    given = connection.headers.getlist(HEADER)
    if not given:
        return None
    text = given[0].strip(" \t")
    quoted = STRING.fullmatch(text)
    key = re.sub(r"\\(.)", r"\1", quoted[1]) if quoted else text
    if len(given) > 1 or not (quoted or BARE.fullmatch(text)) or not 1 <= len(key) <= LONGEST:
        raise ProblemError(
            400,
            f"the header {HEADER} has one string of 1 to {LONGEST} printable ASCII characters in "
            f"quotation marks: {PARAMETER['example']}",
        )
    return key
