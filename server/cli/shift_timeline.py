"""What is to be done in a shift, each thing at its moment of the site's clock."""

import asyncio
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass

from mend.errors import RefusalError

Deed = Callable[[], Awaitable[None]]


@dataclass(frozen=True, slots=True)
class Due:
    """Something to be done at a moment of the site's clock; `ends`: it ends what went on so far."""

    at_s: float
    do: Deed
    ends: bool = False


class Timeline:
    """Does what is due, one after the other by their moments; what cannot be done is told.

    What ends at a moment has ended before what begins at it.

    As one of them may need what an earlier one did (who cancels something has asked for it), each
    is over before the next begins. So nothing that is due may wait for long: that goes `beside`.
    """

    def __init__(
        self, wait_until: Callable[[float], Awaitable[None]], refused: Callable[[str], None]
    ) -> None:
        """`wait_until` comes back when the site's clock has come to a moment (s)."""
        self._wait_until, self._refused = wait_until, refused
        self._waiting: asyncio.TaskGroup | None = None

    async def run(self, due: Iterable[Due]) -> None:
        """Do it all; over when also what went on `beside` is."""
        async with asyncio.TaskGroup() as self._waiting:
            for each in sorted(due, key=lambda each: (each.at_s, not each.ends)):
                await self._wait_until(each.at_s)
                await self._tried(each.do)

    def beside(self, deed: Deed) -> None:
        """Do something that may wait for long, while what is due goes on."""
        assert self._waiting is not None, "only what is due waits for more"
        self._waiting.create_task(self._tried(deed))

    async def _tried(self, deed: Deed) -> None:
        try:
            await deed()
        except RefusalError as error:
            self._refused(str(error))
