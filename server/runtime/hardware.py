"""What stands behind a run's robots."""

from typing import Protocol


class Hardware(Protocol):
    """What stands behind a run's robots: simulated worlds that can be started again, or nothing."""

    @property
    def simulated(self) -> bool: ...

    async def restart(self, robot: str) -> None:
        """Start a simulated robot (again), with its world as the journal has it."""
        ...

    def came(self, robot: str) -> None:
        """A robot has connected."""
        ...

    async def release(self) -> None:
        """The run has ended: stop simulated robots, let go of real ones."""
        ...
