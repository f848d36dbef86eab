"""The robot endpoint on a real socket of this machine."""

import asyncio
import socket
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager

import uvicorn
from fastapi import FastAPI

from mend.server.access.access import Access
from mend.server.api.robot_socket import ROBOT_PATH, add_robot_route
from mend.server.robots.registry import RobotRegistry
from mend.server.serving import MAX_SOCKET_MESSAGE_BYTES
from mend.server.websocket_protocol import WebSocketProtocol


class _Server(uvicorn.Server):
    """A uvicorn that leaves signals to pytest, which has to end a test that hangs."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


@asynccontextmanager
async def served(
    registry: RobotRegistry,
    token: str | None = None,
    port: int = 0,
    *,
    access: Access | None = None,
) -> AsyncIterator[str]:
    """Serve robots; gives the URL that they connect to."""
    app = FastAPI()
    access = access or Access(token, wall_time_s=time.time)
    add_robot_route(app, registry, access)
    listener = socket.create_server(("127.0.0.1", port))
    config = uvicorn.Config(
        app,
        log_level="warning",
        ws=WebSocketProtocol,
        ws_max_size=MAX_SOCKET_MESSAGE_BYTES,
        lifespan="off",
    )
    server = _Server(config)
    task = asyncio.create_task(server.serve(sockets=[listener]))
    try:
        yield f"ws://127.0.0.1:{listener.getsockname()[1]}{ROBOT_PATH}"
    finally:
        registry.close()
        server.should_exit = True
        await task
        listener.close()
