"""Beginning a run once the robots that it names are connected."""

import asyncio
from collections.abc import Callable
from uuid import UUID

from mend.server.cli.failures import CommandLineError
from mend.server.cli.run_host import RunHost
from mend.server.errors import NotConnectedError
from mend.server.runtime.ports import LIVE
from mend.server.runtime.requests import RunRequest

LOOK_EVERY_S = 0.2


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
        self._note(
            f"Waiting for {', '.join(lacking.robots)} at {self._host.door}: {lacking}. "
            f"After {self._wait_s:g} s this gives up; Ctrl-C does so now."
        )
        try:
            async with asyncio.timeout(self._wait_s):
                while not set(lacking.robots) <= await self._connected():  # noqa: ASYNC110 - it may be elsewhere
                    await asyncio.sleep(LOOK_EVERY_S)
        except TimeoutError:
            raise CommandLineError(
                f"{lacking}; it was waited for {self._wait_s:g} s at {self._host.door}"
            ) from None

    async def _connected(self) -> set[str]:
        return {each.robot for each in await self._host.robots() if each.connected}
