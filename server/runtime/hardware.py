"""What stands behind a run's robots."""

from collections.abc import Sequence
from typing import Protocol

from mend.server.runtime.clock import RunClock
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.team import Neighbour


class Hardware(Protocol):
    """What stands behind a run's robots: simulated worlds that can be started again, or nothing."""

    @property
    def simulated(self) -> bool: ...

    def clock(self, start_s: float) -> RunClock:
        """The clock of a run that is so far."""
        ...

    def lend(self) -> None:
        """The run has its robots from now on."""
        ...

    async def begin(self, robot: str) -> None:
        """The run begins, or goes on: a simulated robot that is not there is started."""
        ...

    async def restart(self, robot: str) -> None:
        """Start a simulated robot (again), with its world as the journal has it."""
        ...

    def came(self, proxy: RobotProxy) -> None:
        """A robot has connected."""
        ...

    def neighbours(self) -> Sequence[Neighbour]:
        """Who else uses the same table."""
        ...

    def tell_neighbours(self) -> None:
        """Something has changed that they may have waited for."""
        ...

    async def release(self) -> None:
        """The run has ended: stop simulated robots, let go of real ones."""
        ...
