"""What a base may ask of elevators."""

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

    def is_open_for(self, ride: Ride) -> bool:
        """Whether the cabin is open where the ride begins, and this robot's turn it is."""
        ...


class NoElevators:
    """Where there are none."""

    def ask(self, ride: Ride, *, stay_open: bool = False) -> None:
        """Nobody hears it."""

    def withdraw(self) -> None:
        """Nothing."""

    def is_open_for(self, ride: Ride) -> bool:  # noqa: ARG002
        """Never."""
        return False
