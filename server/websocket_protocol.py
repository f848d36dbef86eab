"""WebSockets as uvicorn speaks them, which can be shut down at any moment."""

import asyncio

from uvicorn._types import ASGISendEvent
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.exceptions import PayloadTooBig
from websockets.frames import Frame
from websockets.protocol import State

from mend.server.limits import LimitName
from mend.server.visitors import STATE_KEY, Beyond, Visitor

STRANGER_MESSAGE_BYTES = 64 * 1024
"""Long enough for a token."""

READ_BYTES = 16 * 1024
"""So much is read at a time: whoever sends thousands of frames at once keeps nobody waiting."""

MOST_FRAGMENTS = 256
"""So many parts a message may come in."""

PINGS_AT_ONCE = 100
PINGS_PER_S = 10.0
"""More pings than any client needs, at once and in the long run."""

POLICY_VIOLATION, TOO_BIG = 1008, 1009

LATE_S = 1.0
"""A timer that runs so much later than it should says that this process had no time."""


class WebSocketProtocol(WebSocketsSansIOProtocol):
    """Uvicorn's own, but for clients that are just closing, or that send frames without end."""

    _pong_within_s = 0.0
    """How long after the ping its answer is awaited."""
    _pings_left = float(PINGS_AT_ONCE)
    _pinged_at_s = 0.0

    @property
    def _visitor(self) -> Visitor | None:
        """The visitor of `app_state`, where there is one."""
        visitor: Visitor | None = self.app_state.get(STATE_KEY)
        return visitor

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        if hasattr(transport, "max_size"):
            transport.max_size = READ_BYTES

    def connection_lost(self, exc: Exception | None) -> None:
        if self._visitor is not None:
            self._visitor.leave()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Read on; a stranger's messages are short, so that many strangers fill no memory."""
        stranger = self._visitor is not None and not self._visitor.is_admitted
        most = self.config.ws_max_size
        self.conn.max_message_size = min(most, STRANGER_MESSAGE_BYTES) if stranger else most
        super().data_received(data)

    def handle_cont(self, event: Frame) -> None:
        """Take a part of a message; one in too many parts is never put together."""
        if self._has_ended:
            return
        if len(self.frames) >= MOST_FRAGMENTS:
            reason = f"a message comes in at most {MOST_FRAGMENTS} parts"
            self._end(TOO_BIG, Beyond("message_parts", reason))
            return
        super().handle_cont(event)

    def handle_ping(self) -> None:
        """Answer a ping, unless so much waits for the client already, or it pings without end."""
        if self._has_ended:
            return
        now_s = self.loop.time()
        refilled = self._pings_left + (now_s - self._pinged_at_s) * PINGS_PER_S
        self._pings_left, self._pinged_at_s = min(refilled, PINGS_AT_ONCE) - 1.0, now_s
        if self._pings_left < 0.0:
            reason = f"at most {PINGS_PER_S:g} pings a second"
            self._end(POLICY_VIOLATION, Beyond("pings", reason))
        elif self.writable.is_set():
            super().handle_ping()
        else:
            # The pong that was made for it.
            self.conn.data_to_send()

    async def send(self, message: ASGISendEvent) -> None:
        """Send on; a refusal answers the handshake as well.

        Uvicorn would say in the log that the application had forgotten it.
        """
        await super().send(message)
        if message["type"] == "websocket.http.response.body" and not message.get("more_body"):
            self.handshake_complete = True

    @property
    def _has_ended(self) -> bool:
        """What has still been read when a connection was ended is of no use any more."""
        return self.transport.is_closing()

    def handle_parser_exception(self) -> None:
        """End the connection; who is just sending hears that the client is gone.

        Uvicorn would call it a mistake of the application.
        """
        if isinstance(self.conn.parser_exc, PayloadTooBig):
            most = self.conn.max_message_size
            stranger = most != self.config.ws_max_size
            limit: LimitName = "stranger_message_bytes" if stranger else "message_bytes"
            self._note(Beyond(limit, f"a message was longer than {most} bytes"))
        super().handle_parser_exception()
        self.close_sent = False

    def _note(self, beyond: Beyond) -> None:
        if self._visitor is not None:
            self._visitor.note(beyond)

    def _end(self, code: int, beyond: Beyond) -> None:
        """End the connection, as uvicorn does for what is no WebSocket."""
        self._note(beyond)
        self.frames = []
        if self.conn.state is State.OPEN:
            self.conn.send_close(code, beyond.sentence)
            self.handle_parser_exception()
        else:
            self.transport.abort()

    def keepalive_timeout(self) -> None:
        """End the connection to a client that does not answer; not while it is us who are late.

        Its answer may have come while this process was stopped, and not be read yet.
        """
        assert self.ping_timeout is not None, "there is no time-out without it"
        now = self.loop.time()
        if now - self.ping_sent_at > self._pong_within_s + LATE_S:
            self._pong_within_s = now - self.ping_sent_at + self.ping_timeout
            self.pong_timer = self.loop.call_later(self.ping_timeout, self.keepalive_timeout)
            return
        super().keepalive_timeout()

    def send_keepalive_ping(self) -> None:
        """Send a ping, to be answered in time."""
        self._pong_within_s = self.ping_timeout or 0.0
        super().send_keepalive_ping()

    def shutdown(self) -> None:
        """End the connection because the server ends.

        Uvicorn would tell one that is just closing once more that it ends, which raises, and then
        leave all others as they are, and the service half shut down.
        """
        if self.conn.state in (State.CONNECTING, State.OPEN):
            super().shutdown()
            return
        self.stop_keepalive()
        self.transport.close()
