"""The server: uvicorn's, which takes its connections from an acceptor of ours."""

import asyncio
import socket
import ssl
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import uvicorn
from fastapi import FastAPI
from starlette.types import ASGIApp, Receive, Scope, Send
from uvicorn.config import STARTUP_FAILURE

from mend.server.accepting import Acceptor
from mend.server.http_protocol import HttpProtocol
from mend.server.log_secrets import hide_secrets
from mend.server.proxies import TrustedProxies
from mend.server.refusals import Refusals
from mend.server.settings import Settings
from mend.server.visitors import STATE_KEY, Visitor, Visitors
from mend.server.websocket_protocol import WebSocketProtocol

MAX_SOCKET_MESSAGE_BYTES = 1024 * 1024
"""Robots send pictures; helpers get an `error` message for anything above 64 KiB."""

GRACE_S = 0.5
"""So long the service waits for answers that are being made or sent when it is to end."""


def serve_config(app: FastAPI, settings: Settings) -> uvicorn.Config:
    """How uvicorn serves the application."""
    proxies = TrustedProxies(settings.trusted_proxies)
    config = uvicorn.Config(
        _until_cut_off(app),
        host=settings.host,
        port=settings.port,
        log_level=settings.log_level,
        http=HttpProtocol,
        ws=WebSocketProtocol,
        ws_max_size=MAX_SOCKET_MESSAGE_BYTES,
        # Compressing the same event again for every client costs more than it saves.
        ws_per_message_deflate=False,
        # For what has not ended though it was cut off.
        timeout_graceful_shutdown=5,
        server_header=False,
        # Anybody can send such headers: they are believed of configured proxies only.
        proxy_headers=bool(proxies),
        forwarded_allow_ips=proxies.as_written,
    )
    # After the configuration, which sets up uvicorn's loggers.
    hide_secrets(settings.token.get_secret_value() if settings.token else None)
    return config


def _until_cut_off(app: FastAPI) -> ASGIApp:
    """The application, which may be cancelled: uvicorn would call that a mistake of it."""

    async def answer(scope: Scope, receive: Receive, send: Send) -> None:
        with suppress(asyncio.CancelledError):
            await app(scope, receive, send)

    return answer


class Server(uvicorn.Server):
    """A uvicorn within somebody else's event loop, on sockets that are bound already.

    `now` is any monotonic clock in seconds: by it connections are ended.
    """

    def __init__(
        self,
        config: uvicorn.Config,
        settings: Settings,
        refusals: Refusals,
        tls: ssl.SSLContext | None = None,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(config)
        proxies = TrustedProxies(settings.trusted_proxies)
        self.visitors = Visitors(settings.limits, refusals, now, proxies)
        self._tls = tls

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals to whoever opened the service."""
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Take connections from now on."""
        await self.lifespan.startup()
        if self.lifespan.should_exit:
            sys.exit(STARTUP_FAILURE)
        acceptors = [
            Acceptor(each, self._protocol, self.visitors, self._tls) for each in sockets or []
        ]
        for acceptor in acceptors:
            acceptor.start(self.config.backlog)
        self.servers = acceptors  # type: ignore[assignment]
        self.started = True

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Take no more connections, and end those there are, soon whatever is under way on them."""
        cutting = asyncio.get_running_loop().call_later(GRACE_S, self._cut_off)
        try:
            await super().shutdown(sockets)
        finally:
            cutting.cancel()

    def _cut_off(self) -> None:
        for connection in list(self.server_state.connections):
            if isinstance(connection, HttpProtocol):
                connection.cut_off()
            else:
                connection.transport.abort()
        for task in self.server_state.tasks:
            task.cancel()

    def _protocol(self, visitor: Visitor) -> asyncio.Protocol:
        state = self.lifespan.state | {STATE_KEY: visitor}
        return HttpProtocol(self.config, self.server_state, state)

    async def wait_until_started(self, serving: "asyncio.Task[None]") -> None:
        """Return once it listens; raises what kept it from doing so."""
        while not self.started:
            if serving.done():
                serving.result()
                raise OSError("the server ended before it listened")
            await asyncio.sleep(0.005)
