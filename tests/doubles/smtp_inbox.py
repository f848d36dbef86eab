"""A real SMTP server on loopback that keeps what it takes in."""

import asyncio
import ssl
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from dataclasses import dataclass, field
from email import message_from_bytes
from email.message import EmailMessage
from email.policy import default
from typing import Any

from aiosmtpd.smtp import SMTP, Envelope, Session


@dataclass
class Inbox:
    """What a local SMTP server took in, and whom it refuses."""

    refuses: tuple[str, ...] = ()
    refusal: str = "550 no such mailbox"
    mails: list[EmailMessage] = field(default_factory=list)
    recipients: list[str] = field(default_factory=list)

    async def handle_RCPT(  # noqa: N802 - the name that aiosmtpd calls
        self,
        server: SMTP,  # noqa: ARG002
        session: Session,  # noqa: ARG002
        envelope: Envelope,
        address: str,
        rcpt_options: list[str],  # noqa: ARG002
    ) -> str:
        if address in self.refuses:
            return self.refusal
        envelope.rcpt_tos.append(address)
        return "250 OK"

    async def handle_DATA(  # noqa: N802 - the name that aiosmtpd calls
        self,
        server: SMTP,  # noqa: ARG002
        session: Session,  # noqa: ARG002
        envelope: Envelope,
    ) -> str:
        assert isinstance(envelope.content, bytes)
        self.recipients += envelope.rcpt_tos
        self.mails.append(message_from_bytes(envelope.content, policy=default))
        return "250 OK"


class Watched(asyncio.Protocol):
    """Knows its connection, so that a test leaves none open."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.connection: asyncio.WriteTransport | None = None
        self.lost = asyncio.Event()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.WriteTransport)
        self.connection = transport
        super().connection_made(transport)

    def connection_lost(self, error: Exception | None) -> None:
        super().connection_lost(error)
        self.lost.set()


class WatchedSMTP(Watched, SMTP):
    """An SMTP connection that a test can end."""


@asynccontextmanager
async def listening(
    protocol: Callable[[], Watched], tls: ssl.SSLContext | None = None
) -> AsyncIterator[int]:
    """A server on loopback; gives its port."""
    served: list[Watched] = []

    def serve() -> Watched:
        served.append(protocol())
        return served[-1]

    server = await asyncio.get_running_loop().create_server(serve, "127.0.0.1", 0, ssl=tls)
    try:
        yield server.sockets[0].getsockname()[1]
    finally:
        server.close()
        for each in served:
            if each.connection is not None:
                try:
                    each.connection.abort()
                except AttributeError:
                    # Early Pythons 3.11 cannot abort what was closed twice; it ends by itself.
                    async with asyncio.timeout(20):
                        await each.lost.wait()


def smtp_server(inbox: Inbox) -> AbstractAsyncContextManager[int]:
    return listening(lambda: WatchedSMTP(inbox))
