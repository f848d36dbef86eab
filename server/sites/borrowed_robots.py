"""What stands behind the robots of a run in a simulated world: the site that they are of."""

from collections.abc import Awaitable, Callable, Sequence

from mend.server.runtime.clock import RunClock, SimulatedClock
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run import Run
from mend.server.runtime.team import Neighbour
from mend.server.sites.site import Site


class BorrowedRobots:
    """A run's robots, borrowed from a site. Implements `mend.server.runtime.hardware.Hardware`.

    `give_back` is called with the run at its end; `starts_world`: the site is there for it alone,
    and its world is started when the run begins.
    """

    simulated = True

    def __init__(
        self,
        site: Site,
        run: Callable[[], Run],
        give_back: Callable[[Run], Awaitable[None]],
        *,
        starts_world: bool,
        began_s: float | None = None,
    ) -> None:
        """`began_s`: what the world's clock said when the run began, as far as that is known."""
        self._site = site
        self._run = run
        self._give_back = give_back
        self._starts_world = starts_world
        self._began_s = began_s

    def clock(self, start_s: float) -> RunClock:
        """The world's, by which the run is so far."""
        # Of one that goes on after a restart it says nothing: the world may have gone back since.
        began_s = self._began_s if start_s == 0.0 else None
        return SimulatedClock(start_s, self._site.world.time, began_s, lambda: self._site.shown_s)

    def lend(self) -> None:
        """The run has its robots from now on."""
        self._site.lend(self._run())

    async def begin(self, robot: str) -> None:
        """Start the world, where it is there for this run alone."""
        if self._starts_world:
            await self.restart(robot)

    async def restart(self, robot: str) -> None:
        """Start the world again for all robots in it."""
        await self._site.world.restart(robot)

    def came(self, proxy: RobotProxy) -> None:
        """A robot has connected."""
        self._site.came(proxy)

    def neighbours(self) -> Sequence[Neighbour]:
        """Other runs at this site, and its robots that none has."""
        return self._site.neighbours_of(self._run())

    def tell_neighbours(self) -> None:
        """Something has changed in this run."""
        self._site.tell_neighbours(self._run())

    async def release(self) -> None:
        """The run has ended, or the service stops."""
        await self._give_back(self._run())
