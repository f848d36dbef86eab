"""WebSockets as uvicorn speaks them, which can be shut down at any moment."""

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.protocol import State


class WebSocketProtocol(WebSocketsSansIOProtocol):
    """Uvicorn's own, but for a connection that its client is just closing.

    Uvicorn would tell it once more that it ends, which raises, and then leave all others as they
    are, and the service half shut down.
    """

    def shutdown(self) -> None:
        """End the connection because the server ends."""
        if self.conn.state in (State.CONNECTING, State.OPEN):
            super().shutdown()
            return
        self.stop_keepalive()
        self.transport.close()
