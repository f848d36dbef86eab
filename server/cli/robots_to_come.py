"""Beginning a run once the robots that it names are connected."""

import asyncio
import signal
from collections.abc import Callable
from uuid import UUID

from mend.server.cli.failures import INTERRUPTED, CommandLineError
from mend.server.cli.run_host import RunHost
from mend.server.errors import NotConnectedError
from mend.server.runtime.ports import LIVE
from mend.server.runtime.requests import RunRequest

LOOK_EVERY_S = 0.2

SIGNALS = (signal.SIGINT, signal.SIGTERM)
"""Also where whoever began the command has it ignore them otherwise."""


class RobotsToCome:
    """Waits for a run's robots; `note` says so, `wait_s` is for how long."""

    def __init__(self, host: RunHost, note: Callable[[str], None], wait_s: float) -> None:
        self._host = host
        self._note = note
        self._wait_s = wait_s

    async def start(self, request: RunRequest) -> UUID:
        """Begin a run. Raises `CommandLineError` where robots do not come, or are not named."""
        if request.world == LIVE and not request.robots:
            free = [
                f"'{each.robot}'"
                for each in await self._host.robots()
                if each.connected and each.run is None
            ]
            raise CommandLineError(
                "--world live needs --robot NAME, once for each robot; connected and free: "
                f"{', '.join(free) or 'none'}"
            )
        try:
            return await self._host.start(request)
        except NotConnectedError as error:
            # Whatever else is wrong with the request was told before.
            await self._wait_for(error)
        return await self._host.start(request)

    async def _wait_for(self, lacking: NotConnectedError) -> None:
        interrupt = asyncio.Event()
        coming = asyncio.create_task(self._all_come(set(lacking.robots)))
        interrupted = asyncio.create_task(interrupt.wait())
        loop = asyncio.get_running_loop()
        for number in SIGNALS:
            loop.add_signal_handler(number, interrupt.set)
        self._note(
            f"Waiting for {', '.join(lacking.robots)} at {self._host.door}: {lacking}. "
            f"After {self._wait_s:g} s this gives up; Ctrl-C does so now."
        )
        try:
            first = asyncio.FIRST_COMPLETED
            await asyncio.wait({coming, interrupted}, timeout=self._wait_s, return_when=first)
            if interrupted.done():
                raise CommandLineError("interrupted", INTERRUPTED)
            if not coming.done():
                raise CommandLineError(
                    f"{lacking}; it was waited for {self._wait_s:g} s at {self._host.door}"
                )
            await coming
        finally:
            for task in (coming, interrupted):
                task.cancel()
            for number in SIGNALS:
                loop.remove_signal_handler(number)

    async def _all_come(self, robots: set[str]) -> None:
        while not robots <= await self._connected():  # noqa: ASYNC110 - it may be elsewhere
            await asyncio.sleep(LOOK_EVERY_S)

    async def _connected(self) -> set[str]:
        return {each.robot for each in await self._host.robots() if each.connected}
