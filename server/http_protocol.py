"""HTTP as uvicorn speaks it, for clients that do not finish what they begin."""

import asyncio
from http import HTTPStatus
from typing import Any

import h11
from uvicorn import Config
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.server import ServerState

from mend.server.raw_answers import raw_problem
from mend.server.visitors import STATE_KEY, Beyond, ConnectionPhase, Visitor

TOO_LATE = ("head_s", "body_s")
SHUTTING_DOWN = "the service is shutting down"


class HttpProtocol(H11Protocol):
    """Uvicorn's own, and tells the visitor of `app_state` what it is waiting for."""

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self._visitor: Visitor = app_state[STATE_KEY]

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._visitor.connected(transport, self._end)

    def connection_lost(self, exc: Exception | None) -> None:
        self._visitor.leave()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        self._look()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        self._look()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """Hand the connection over: from now on its client owes no request."""
        self._visitor.enter(ConnectionPhase.SERVICE)
        self._visitor.end = lambda _: self.transport.abort()
        super().handle_websocket_upgrade(event)

    def send_400_response(self, msg: str) -> None:
        """Refuse what is no HTTP."""
        self._answer(HTTPStatus.BAD_REQUEST, msg)

    def _look(self) -> None:
        """See what the client owes now."""
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return
        if self.conn.their_state is h11.SEND_BODY:
            self._visitor.enter(ConnectionPhase.BODY)
        elif self.conn.their_state is h11.IDLE and (self.cycle is None or self._has_begun()):
            self._visitor.enter(ConnectionPhase.HEAD)
        else:
            self._visitor.enter(ConnectionPhase.SERVICE)

    def _has_begun(self) -> bool:
        """Whether there is a part of a request that could not be read yet."""
        return bool(self.conn.trailing_data[0])

    def shutdown(self) -> None:
        """End the connection because the server ends, once what was asked for is answered.

        What has not come by now is not waited for.
        """
        if self.conn.their_state is h11.SEND_BODY:
            self.cut_off()
        else:
            super().shutdown()

    def cut_off(self) -> None:
        """End the connection now because the server ends, whatever is under way on it."""
        self._cut_off(HTTPStatus.SERVICE_UNAVAILABLE, SHUTTING_DOWN)

    def _end(self, beyond: Beyond) -> None:
        """End the connection; a client that is only slow is told why."""
        if beyond.limit in TOO_LATE:
            self._cut_off(HTTPStatus.REQUEST_TIMEOUT, beyond.sentence)
        else:
            self.transport.abort()

    def _cut_off(self, status: HTTPStatus, why: str) -> None:
        """End the connection in the middle of a request; why is said where an answer is owed."""
        owed = self.conn.our_state in (h11.IDLE, h11.SEND_RESPONSE)
        if self.transport.is_closing() or not owed:
            self.transport.abort()
            return
        if self.cycle is not None:
            # The application hears that the client is gone, and can answer nothing more.
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        self._answer(status, why)

    def _answer(self, status: HTTPStatus, detail: str) -> None:
        self.transport.write(raw_problem(status, detail))
        self.transport.close()
