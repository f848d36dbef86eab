"""A channel to the service over a WebSocket."""

import json
import ssl

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus

from mend.robots.link.channel import ChannelClosedError, LinkRefusedError

MAX_MESSAGE_BYTES = 1 << 20
TOO_MANY_REQUESTS = 429


class WebSocketChannel:
    """The robot's end of a WebSocket."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection

    async def send(self, text: str) -> None:
        try:
            await self._connection.send(text)
        except ConnectionClosed as error:
            raise ChannelClosedError(str(error)) from error

    async def receive(self) -> str:
        try:
            return await self._connection.recv(decode=True)
        except ConnectionClosed as error:
            raise ChannelClosedError(str(error)) from error

    async def close(self) -> None:
        await self._connection.close()


async def websocket_channel(
    url: str,
    token: str | None,
    tls: ssl.SSLContext | None = None,
    *,
    ping_s: float | None = 20.0,
) -> WebSocketChannel:
    """Connect to the service at `url` (`ws://` or `wss://`, path `/ws/robot`).

    Every `ping_s` it is asked whether it is there, and given up if it does not say so within as
    long again; never with None, as where the end of its process is noticed otherwise.
    `tls` says whom to trust instead of those whom this machine trusts. Raises `LinkRefusedError` if
    the service turns the robot away (a wrong token) and `ChannelClosedError` if there is none.
    """
    headers = {} if token is None else {"Authorization": f"Bearer {token}"}
    try:
        connection = await connect(
            url,
            additional_headers=headers,
            compression=None,
            max_size=MAX_MESSAGE_BYTES,
            user_agent_header=None,
            proxy=None,
            ping_interval=ping_s,
            ping_timeout=ping_s,
            ssl=tls or (True if url.startswith("wss:") else None),
        )
    except InvalidStatus as error:
        status, body = error.response.status_code, bytes(error.response.body or b"")
        if status == TOO_MANY_REQUESTS:
            raise ChannelClosedError(f"{url} asks to wait: {_detail(body, status)}") from error
        if 400 <= status < 500:
            raise LinkRefusedError(
                f"{url} turned the robot away: {_detail(body, status)}"
            ) from error
        raise ChannelClosedError(f"{url} answered with status {status}") from error
    except (OSError, InvalidHandshake) as error:
        raise ChannelClosedError(f"no service at {url}: {error}") from error
    return WebSocketChannel(connection)


def _detail(body: bytes, status: int) -> str:
    """What a refusal says: a problem document (RFC 9457), or plain text."""
    text = body.decode(errors="replace").strip()
    try:
        problem = json.loads(text)
    except (ValueError, RecursionError):
        return text or f"HTTP status {status}"
    detail = problem.get("detail") if isinstance(problem, dict) else None
    return detail if isinstance(detail, str) else text
