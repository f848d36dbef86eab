"""Taking connections in: as many as there may be, and none while there is no descriptor left."""

import asyncio
import errno
import logging
import socket
import ssl
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from http import HTTPStatus

from mend.server.background import Endless
from mend.server.descriptors import NO_DESCRIPTOR, TRY_AGAIN_S
from mend.server.rare_log import RareLog
from mend.server.raw_answers import raw_problem
from mend.server.visitors import Beyond, Visitor, Visitors

log = logging.getLogger(__name__)

NO_ROOM = (*NO_DESCRIPTOR, errno.ENOBUFS, errno.ENOMEM)
"""The process or the machine has no descriptor or memory left for one more connection."""

LOOK_EVERY_S = 0.25
"""How often connections are looked at for one that is overdue."""

TLS_SHUTDOWN_S = 2.0

MakeProtocol = Callable[[Visitor], asyncio.Protocol]


class Acceptor:
    """Takes connections of one listening socket in, and ends those that are overdue.

    It can be closed like an `asyncio.Server`. With `tls` every connection begins with a handshake.
    """

    def __init__(
        self,
        listening: socket.socket,
        make_protocol: MakeProtocol,
        visitors: Visitors,
        tls: ssl.SSLContext | None = None,
    ) -> None:
        self.sockets = (listening,)
        self._listening = listening
        self._make_protocol = make_protocol
        self._visitors = visitors
        self._tls = tls
        self._rare_log = RareLog(log, visitors.now)
        self._connecting: set[asyncio.Task[None]] = set()
        self._work: list[asyncio.Task[None]] = []

    def start(self, backlog: int) -> None:
        """Listen, with as many connections waiting in the kernel."""
        self._listening.setblocking(False)
        self._listening.listen(backlog)
        self._work = [
            asyncio.create_task(self._accept(), name="accepting"),
            asyncio.create_task(self._end_overdue(), name="overdue connections"),
        ]

    def close(self) -> None:
        """Take no more connections; those there are stay."""
        for task in (*self._work, *self._connecting):
            task.cancel()
        self._listening.close()

    async def wait_closed(self) -> None:
        """Wait until nothing is under way any more."""
        await asyncio.gather(*self._work, *self._connecting, return_exceptions=True)

    async def _end_overdue(self) -> None:
        ending = Endless("ending overdue connections")
        while True:
            await asyncio.sleep(LOOK_EVERY_S)
            with ending.one_pass():
                self._visitors.end_overdue()

    async def _accept(self) -> None:
        accepting = Endless("accepting connections")
        while True:
            with accepting.one_pass():
                await self._accept_one()
            # A connection that waits already is accepted without waiting.
            await asyncio.sleep(0)

    async def _accept_one(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            connection, address = await loop.sock_accept(self._listening)
        except OSError as error:
            await self._not_accepted(error)
            return
        try:
            self._welcome(connection, address[0])
        except Exception:
            connection.close()
            raise

    async def _not_accepted(self, error: OSError) -> None:
        """What is no fault of one connection would come again at once, and for ever."""
        if error.errno in NO_ROOM:
            self._rare_log.warn(
                "no room", f"no more connections can be taken just now: {error.strerror}"
            )
            await asyncio.sleep(TRY_AGAIN_S)

    def _welcome(self, connection: socket.socket, address: str) -> None:
        connection.setblocking(False)

        def end(_: Beyond) -> None:
            task.cancel()

        visitor = self._visitors.come(address, end)
        if isinstance(visitor, Beyond):
            self._turn_away(connection, visitor)
            return
        task = asyncio.create_task(self._connect(connection, visitor), name="connecting")
        self._connecting.add(task)
        task.add_done_callback(self._connecting.discard)

    def _turn_away(self, connection: socket.socket, beyond: Beyond) -> None:
        """Say why, where that can be said without waiting, and hang up."""
        unavailable = HTTPStatus.SERVICE_UNAVAILABLE
        with suppress(OSError):
            if self._tls is None:
                connection.send(raw_problem(unavailable, beyond.sentence, retry_after_s=10))
                connection.shutdown(socket.SHUT_WR)
        connection.close()

    async def _connect(self, connection: socket.socket, visitor: Visitor) -> None:
        """Make the connection a visitor's; it leaves again if there is no handshake."""
        loop = asyncio.get_running_loop()
        made = False
        try:
            await loop.connect_accepted_socket(
                partial(self._make_protocol, visitor),
                connection,
                ssl=self._tls,
                ssl_shutdown_timeout=TLS_SHUTDOWN_S if self._tls else None,
            )
            made = True
        except OSError as error:
            log.debug("a connection ended before its TLS handshake did: %s", error)
        finally:
            if not made:
                visitor.leave()
                connection.close()
