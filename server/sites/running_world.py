"""One simulated world that runs: started, and started again as the journal has it."""

from collections.abc import Callable
from functools import partial
from uuid import UUID

from mend.server.journal.journal import Journal
from mend.server.runtime.clock import WorldTime
from mend.server.sites.worlds import Launch, RobotNames, WorldHandle
from mend.sim.world import WorldSetup


class RunningWorld:
    """The program of a simulated world, which may end and is then started again.

    `lost` is told of each robot, with the reason, when it has ended without being stopped. From now
    on nobody else can come in under the names of its robots.
    """

    def __init__(
        self,
        launch: Launch,
        journal: Journal,
        names: RobotNames,
        kind: str,
        kept_as: UUID,
        setup: WorldSetup,
        lost: Callable[[str, str], None],
    ) -> None:
        """`kind` is the world's name, `kept_as` what the journal keeps its state under."""
        self.time = WorldTime()
        self._launch = launch
        self._journal = journal
        self._names = names
        self._kind = kind
        self._kept_as = kept_as
        self._setup = setup
        self._lost = lost
        self._handle: WorldHandle | None = None
        self._life = 0
        self._started_with: set[str] = set()
        names.reserve(setup.robots)

    async def start(self) -> None:
        """Start the world, as the journal has it if it has it, and all robots in it.

        Raises `WrongInputError` if it cannot run here.
        """
        await self._start()
        self._started_with.clear()

    async def restart(self, robot: str) -> bool:
        """Start it for a robot that is not there; whether it was.

        It is started once for all of them: no robot needs that again before it has come.
        """
        if robot in self._started_with:
            self._started_with.discard(robot)
            return False
        self._started_with = {each for each in self._setup.robots if each != robot}
        await self._start()
        return True

    async def _start(self) -> None:
        await self._stop()
        self._life += 1
        snapshot = await self._journal.world(self._kept_as)
        setup = self._setup.model_copy(update={"snapshot": snapshot})
        ended = partial(self._ended, self._life)
        # It may go on from a moment that was over before it ended.
        self.time.begin_anew()
        self._handle = await self._launch(self._kind, setup, ended)

    def came(self, robot: str) -> None:
        """A robot is there."""
        self._started_with.discard(robot)

    def _ended(self, life: int, reason: str) -> None:
        # The end of a world that was already replaced is no news.
        if life == self._life:
            self._started_with.clear()
            for robot in self._setup.robots:
                self._lost(robot, reason)

    async def stop(self) -> None:
        """Stop the world for good; the names of its robots are then free."""
        try:
            await self._stop()
        finally:
            self._names.release(self._setup.robots)

    async def _stop(self) -> None:
        handle, self._handle = self._handle, None
        self._life += 1
        if handle is not None:
            await handle.stop()
