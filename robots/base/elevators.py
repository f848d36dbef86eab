"""What a base may ask of elevators."""

from collections.abc import Mapping
from typing import Protocol

from mend.robots.base.ways import Ride


class Elevators(Protocol):
    """The elevators of a building, as one robot has them.

    What people call is asked for too: whoever helps reads on the robot where it wants to go.
    """

    def ask(self, ride: Ride, *, stay_open: bool = False) -> None:
        """Want this ride; asking again changes nothing but whether the cabin is to `stay_open`."""
        ...

    def withdraw(self) -> None:
        """Want no ride any more."""
        ...

    def heads_for(self, elevator: str) -> None:
        """Say which one it is on its way to, so that others know; until it asks, or withdraws."""
        ...

    def waits_s(self) -> Mapping[str, float]:
        """How long others take who are to ride before it, of each elevator that robots call.

        What people call knows of nobody who waits.
        """
        ...

    def is_open_for(self, ride: Ride) -> bool:
        """Whether the cabin is open where the ride begins, and this robot's turn it is."""
        ...


class NoElevators:
    """Where there are none."""

    def ask(self, ride: Ride, *, stay_open: bool = False) -> None:
        """Nobody hears it."""

    def withdraw(self) -> None:
        """Nothing."""

    def heads_for(self, elevator: str) -> None:
        """Nobody hears it."""

    def waits_s(self) -> Mapping[str, float]:
        """Of none."""
        return {}

    def is_open_for(self, ride: Ride) -> bool:  # noqa: ARG002
        """Never."""
        return False
