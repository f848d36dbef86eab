"""Simulated worlds of runs: starting their robots, and starting them again where they were."""

from collections.abc import Awaitable, Callable, Iterable, Mapping
from functools import partial
from typing import Any, Protocol

import numpy as np

from mend.errors import WrongInputError
from mend.server.journal.journal import Journal
from mend.server.runtime.ports import LIVE
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState
from mend.server.runtime.views import WorldView
from mend.sim.mischief import random_interventions
from mend.sim.world import WorldAdapter, WorldSetup, WorldUnavailableError
from mend.sim.world_options import read_options
from mend.tasks.scenario import ScriptedIntervention


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

    def __init__(
        self,
        adapters: Mapping[str, WorldAdapter],
        journal: Journal,
        launch: Launch,
        names: RobotNames,
    ) -> None:
        self._adapters = adapters
        self._journal = journal
        self._launch = launch
        self._names = names

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

    def open(self, state: RunState, run: Callable[[], Run]) -> "SimulatedHardware":
        """The hardware of a run, which starts it; `run` is asked for only then.

        From now on nobody else can come in under the names of its robots.
        """
        self._names.reserve(state.started.robots)
        return SimulatedHardware(
            self._launch, self._journal, self._names, self._setup(state), state, run
        )

    def _setup(self, state: RunState) -> WorldSetup:
        started, request = state.started, state.request
        interventions: list[ScriptedIntervention] = []
        if state.scenario is not None:
            interventions += state.scenario.interventions
        if request.interventions == "random":
            objects = state.tree.nodes.handled_objects()
            rng = np.random.default_rng([started.seed, len(objects)])
            interventions += random_interventions(objects, state.scene, rng)
        return WorldSetup(
            robots=list(started.robots),
            scene=state.scene,
            seed=started.seed,
            speed=None if started.speed == "max" else started.speed,
            interventions=interventions,
            options=dict(request.world_options),
        )


class SimulatedHardware:
    """The simulated world of one run; implements `mend.server.runtime.hardware.Hardware`."""

    simulated = True

    def __init__(
        self,
        launch: Launch,
        journal: Journal,
        names: RobotNames,
        setup: WorldSetup,
        state: RunState,
        run: Callable[[], Run],
    ) -> None:
        self._launch = launch
        self._journal = journal
        self._names = names
        self._setup = setup
        self._state = state
        self._run = run
        self._handle: WorldHandle | None = None
        self._life = 0
        self._started_with: set[str] = set()

    async def restart(self, robot: str) -> None:
        """Start the world, as the journal has it if it has it, and all robots in it.

        It is started once for all of them: no robot needs that again before it has come.
        """
        if robot in self._started_with:
            self._started_with.discard(robot)
            return
        await self._stop()
        self._life += 1
        snapshot = await self._journal.world(self._state.id)
        setup = self._setup.model_copy(update={"snapshot": snapshot})
        ended = partial(self._ended, self._life)
        self._started_with = {each for each in setup.robots if each != robot}
        self._handle = await self._launch(self._state.started.world, setup, ended)

    def came(self, robot: str) -> None:
        """A robot is there."""
        self._started_with.discard(robot)

    def _ended(self, life: int, reason: str) -> None:
        # The end of a world that was already replaced is no news.
        if life == self._life:
            self._started_with.clear()
            for robot in self._setup.robots:
                self._run().tell_lost(robot, reason)

    async def release(self) -> None:
        """Stop the robot, whose name is then free."""
        try:
            await self._stop()
        finally:
            self._names.release(self._state.started.robots)

    async def _stop(self) -> None:
        handle, self._handle = self._handle, None
        self._life += 1
        if handle is not None:
            await handle.stop()
