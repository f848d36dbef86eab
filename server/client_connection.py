"""A client's WebSocket to the service, whatever it carries: getting in, and reading what comes."""

import contextlib
from collections.abc import AsyncIterator, Iterator
from urllib.parse import urlencode

from pydantic import ValidationError
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidHandshake, InvalidStatus

from mend.server.client_errors import StreamRefusedError, UnreachableError

POLICY_VIOLATION = 1008
TOO_MANY_REQUESTS = 429


class HelperEndpoint:
    """Where one helper gets in at one of the service's WebSockets."""

    def __init__(self, url: str, path: str, headers: dict[str, str], helper: str) -> None:
        self._address = url.replace("http", "ws", 1) + path
        self._headers = headers
        self._helper = helper

    @contextlib.asynccontextmanager
    async def connected(
        self, *, after: int | None = None, compression: str | None = "deflate"
    ) -> AsyncIterator[ClientConnection]:
        """A connection; the events' one goes on from the event `after`.

        Raises `StreamRefusedError`, or `UnreachableError` where it is worth trying again.
        """
        query = {"helper": self._helper} | ({} if after is None else {"after": str(after)})
        connecting = connect(
            f"{self._address}?{urlencode(query)}",
            additional_headers=self._headers,
            compression=compression,
            max_size=None,
        )
        try:
            socket = await connecting
        except InvalidStatus as error:
            status = error.response.status_code
            if status >= 500 or status == TOO_MANY_REQUESTS:
                raise UnreachableError(f"the service is not ready ({status})") from error
            raise StreamRefusedError(
                f"the service refused the connection ({status}): check the token and the address"
            ) from error
        except (OSError, InvalidHandshake, TimeoutError) as error:
            raise UnreachableError(f"no service answers at {self._address}: {error}") from error
        async with socket:
            yield socket


def check_not_turned_away(socket: ClientConnection) -> None:
    """Raises `StreamRefusedError` if the service closed a connection because it wants it not."""
    if socket.close_code == POLICY_VIOLATION:
        raise StreamRefusedError(f"the service closed the connection: {socket.close_reason}")


@contextlib.contextmanager
def readable() -> Iterator[None]:
    """What comes from the service is read in here. Raises `StreamRefusedError` if it cannot be."""
    try:
        yield
    except ValidationError as error:
        raise StreamRefusedError(
            f"the service sent what this client cannot read; is it of another version? ({error})"
        ) from error
