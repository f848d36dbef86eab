"""Where `mend run` has its run carried out."""

from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager
from pathlib import Path
from typing import Literal, Protocol
from uuid import UUID

from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RobotView


class RunHost(Protocol):
    """A service that carries out a run: one of the command's own, or one that was there before."""

    @property
    def door(self) -> str:
        """Where robots connect."""
        ...

    @property
    def journal(self) -> str:
        """Whose journal it is that has the run."""
        ...

    async def robots(self) -> list[RobotView]:
        """Every robot that is or was connected."""
        ...

    async def start(self, request: RunRequest) -> UUID:
        """Begin a run. Raises `NotConnectedError` where robots are still to come."""
        ...

    def events(self, run: UUID) -> AsyncIterator[ev.Event]:
        """The events of a run, as they are committed."""
        ...

    async def stopped(self, run: UUID) -> None:
        """Return once a run goes on no more though it has not ended."""
        ...

    async def answer(
        self, dialogue: UUID, prompt: UUID, answer: Literal["yes", "no"], helper: str
    ) -> object:
        """Answer a prompt. Raises `ConflictError` where that comes too late."""
        ...

    async def abort(self, run: UUID) -> None:
        """End a run, if it has not ended."""
        ...

    async def write_report(self, run: UUID, path: Path) -> None:
        """Write the report of a run that has ended. Raises `OSError`."""
        ...


class OpenHost(Protocol):
    """Gives the host of a run, until its end."""

    def __call__(self) -> AbstractAsyncContextManager[RunHost]: ...
