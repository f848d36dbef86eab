"""Which simulated worlds there are, and starting one."""

from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any, Protocol

from mend.errors import WrongInputError
from mend.server.runtime.ports import LIVE
from mend.server.runtime.views import WorldView
from mend.sim.world import WorldAdapter, WorldSetup, WorldUnavailableError
from mend.sim.world_options import read_options


class WorldHandle(Protocol):
    """A simulated world that runs, in its own process or in this one."""

    async def stop(self) -> None: ...


Launch = Callable[[str, WorldSetup, Callable[[str], None]], Awaitable[WorldHandle]]
"""Starts a world: its name, its setup, and what to call (with a reason) if it ends."""


class RobotNames(Protocol):
    """Where it is known which robots this service runs."""

    def reserve(self, robots: Iterable[str]) -> None:
        """These are to be started; nobody else can come in under their names."""
        ...

    def release(self, robots: Iterable[str]) -> None:
        """These will be started no more."""
        ...


class SimulatedWorlds:
    """The worlds of the entry point group `mend.worlds`."""

    def __init__(self, adapters: Mapping[str, WorldAdapter]) -> None:
        self._adapters = adapters

    def worlds(self) -> list[WorldView]:
        """Every world that a run may be in, and why one cannot run here."""
        live = WorldView(name=LIVE, available=True, reason=None, options={})
        return [live, *(self._view(name) for name in sorted(self._adapters))]

    def _view(self, name: str) -> WorldView:
        adapter = self._adapters[name]
        try:
            adapter.check_available()
            reason = None
        except WorldUnavailableError as error:
            reason = str(error)
        options = adapter.options.model_json_schema().get("properties", {})
        return WorldView(name=name, available=reason is None, reason=reason, options=options)

    def check(self, world: str, options: Mapping[str, Any]) -> None:
        """Raise `WrongInputError` where there is no such world, or none with such options here."""
        if world not in self._adapters:
            known = ", ".join(["live", *self._adapters])
            raise WrongInputError(f"there is no world '{world}'; there are {known}")
        try:
            self._adapters[world].check_available()
        except WorldUnavailableError as error:
            raise WrongInputError(str(error)) from error
        read_options(self._adapters[world].options, world, options)
