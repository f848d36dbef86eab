"""Letting a WebSocket in: Host and Origin before it is accepted, then the token."""

import asyncio
from collections.abc import Awaitable, Callable

from starlette.websockets import WebSocket

from server.api.access import Access

POLICY_VIOLATION = 1008
FIRST_MESSAGE_S = 5.0


async def admit(
    websocket: WebSocket,
    access: Access,
    ask_token: Callable[[], Awaitable[str | None]],
) -> bool:
    """Accept a WebSocket, or close it with 1008.

    The token comes in a bearer header, in the session cookie, or by `ask_token`, which reads it
    from the first message (None when that is something else). Never from the address, which ends
    up in logs.
    """
    if not (access.host_allowed(websocket) and access.origin_allowed(websocket)):
        await websocket.close(POLICY_VIOLATION, "this Host or Origin may not connect")
        return False
    shown = "authorization" in websocket.headers
    if shown and not access.admits(websocket):
        await websocket.close(POLICY_VIOLATION, "this is not the token")
        return False
    await websocket.accept()
    if access.admits(websocket):
        return True
    try:
        async with asyncio.timeout(FIRST_MESSAGE_S):
            token = await ask_token()
    except TimeoutError:
        token = None
    if token is not None and access.token_fits(token):
        return True
    await websocket.close(POLICY_VIOLATION, "the first message must show the token")
    return False
