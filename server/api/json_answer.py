"""Answers of ready JSON, sent in pieces so that a large one is never copied as a whole."""

from collections.abc import AsyncIterator, Mapping, Sequence

from starlette.responses import Response, StreamingResponse

from mend.server.turns import Turns

JSON = "application/json"
PIECE_BYTES = 64 * 1024


def json_answer(
    *json: bytes, status: int = 200, headers: Mapping[str, str] | None = None
) -> Response:
    """An answer whose body is `json`, one piece after the other."""
    length = sum(len(each) for each in json)
    if length <= PIECE_BYTES:
        return Response(b"".join(json), status, headers, JSON)
    given = {**(headers or {}), "Content-Length": str(length)}
    return StreamingResponse(_pieces(json), status, given, JSON)


async def _pieces(json: Sequence[bytes]) -> AsyncIterator[bytes]:
    # A client that reads fast enough would have the loop to itself.
    turns = Turns()
    for each in json:
        for begin in range(0, len(each), PIECE_BYTES):
            yield each[begin : begin + PIECE_BYTES]
            await turns.pass_on()
