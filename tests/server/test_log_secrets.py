"""What a log of every byte shows of secrets."""

import io
import logging

import pytest
from uvicorn.logging import AccessFormatter
from websockets.frames import Frame, Opcode

from mend.server.access.tokens import new_token
from mend.server.app import described_app
from mend.server.log_secrets import ACCESS, LONGEST_CHARS, HideSecrets
from mend.server.serving import serve_config
from mend.server.settings import Settings

OWN = "what-the-service-was-given"


@pytest.mark.parametrize(
    ("said", "logged"),
    [
        ("< authorization: Bearer abc", "< authorization: ***"),
        ("< Cookie: mend_session=1.ab; theme=dark", "< Cookie: ***"),
        ("> Set-Cookie: mend_session=1.ab; HttpOnly", "> Set-Cookie: ***"),
        ("< host: localhost", "< host: localhost"),
        # Where somebody puts it who has not read that it belongs into no address.
        ("GET /api/runs?token=MADE&limit=1", "GET /api/runs?token=***&limit=1"),
        ("GET /ws/helper?access_token=abc", "GET /ws/helper?access_token=***"),
        ("GET /api/MADE/x", "GET /api/mend_***/x"),
        ("GET http://u:MADE@localhost/", "GET http://u:mend_***@localhost/"),
        ("< X-Auth-Token: MADE", "< X-Auth-Token: mend_***"),
        (f"< Sec-WebSocket-Protocol: bearer, {OWN}", "< Sec-WebSocket-Protocol: bearer, ***"),
        (f"GET /{OWN}", "GET /***"),
    ],
)
def test_secrets_are_starred_out(said: str, logged: str) -> None:
    said = said.replace("MADE", new_token().text)
    record = logging.LogRecord("", logging.INFO, "", 0, said, (), None)
    HideSecrets(OWN).filter(record)
    assert record.getMessage() == logged


def test_the_log_of_the_service_shows_no_token() -> None:
    serve_config(described_app(), Settings(port=0, log_level="debug"))
    logger, written = logging.getLogger("uvicorn.error"), io.StringIO()
    handler = logging.StreamHandler(written)
    logger.addHandler(handler)
    try:
        logger.debug("< %s: %s", "authorization", "Bearer abc")
        # In two parts, as whoever sends it likes.
        logger.debug("< %s", Frame(Opcode.TEXT, b'{"type": "auth", "to', fin=False))
        logger.debug("< %s", Frame(Opcode.CONT, b'ken": "abc"}'))
    finally:
        logger.removeHandler(handler)
    assert written.getvalue() == ("< authorization: ***\n< TEXT [20 bytes]\n< CONT [12 bytes]\n")


def test_a_line_of_the_log_is_no_longer_than_it_has_to_be() -> None:
    asked = logging.LogRecord("", logging.INFO, "", 0, "GET /%s 404", ("a" * 60_000,), None)
    HideSecrets().filter(asked)
    assert asked.getMessage() == f"GET /{'a' * (LONGEST_CHARS - 5)}... (60009 characters)"


def test_a_long_request_is_logged_by_its_beginning_as_uvicorn_writes_requests() -> None:
    args = ("127.0.0.1:5", "GET", "/" + "a" * 60_000, "1.1", 404)
    asked = logging.LogRecord(ACCESS, logging.INFO, "", 0, '%s - "%s %s HTTP/%s" %d', args, None)
    HideSecrets().filter(asked)
    written = AccessFormatter("%(client_addr)s %(request_line)s %(status_code)s", use_colors=False)
    line = f"/{'a' * (LONGEST_CHARS - 1)}... (60001 characters)"
    assert written.format(asked) == f"127.0.0.1:5 GET {line} HTTP/1.1 404 Not Found"
