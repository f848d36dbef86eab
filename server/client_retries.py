"""Asking again, under the same idempotency key, where it is not known whether it was done."""

from collections.abc import Awaitable, Callable
from uuid import uuid4

import httpx

from mend.server.api.idempotency_header import HEADER
from mend.server.journal.trouble import Sleep

PAUSES_S = (0.2, 0.5, 1.0, 2.0)
"""Before each further try: a service that is started again takes about so long."""

Send = Callable[[dict[str, str]], Awaitable[httpx.Response]]
"""Sends the request with these headers."""


async def send_once(send: Send, sleep: Sleep) -> httpx.Response:
    """Send a request that is done once, however often it has to be sent until it is answered.

    Raises `httpx.TransportError` where no answer comes.
    """
    headers = {HEADER: f'"{uuid4()}"'}
    may_be_done = False
    for pause_s in PAUSES_S:
        try:
            answer = await send(headers)
        except httpx.TransportError as error:
            # Nothing was sent without a connection, so there is nothing to find out.
            if isinstance(error, httpx.ConnectError) and not may_be_done:
                raise
        else:
            if not _is_under_way(answer):
                return answer
        may_be_done = True
        await sleep(pause_s)
    return await send(headers)


def _is_under_way(answer: httpx.Response) -> bool:
    """Whether the service is still at the first of these requests."""
    return answer.status_code == 409 and "retry-after" in answer.headers
