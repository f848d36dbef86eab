"""How long robots take from place to place: what legs in discrete events are driven by."""

from typing import Protocol

from mend.maps.building.trip import Trip, TripStage
from mend.maps.navigation import NavigationGraph


class TripTimes(Protocol):
    """Trips of a robot of speed 1 if nothing holds it up."""

    def trip(self, origin: str, destination: str) -> Trip:
        """From standing at a place, `FLOOR/PLACE`, to standing at another."""
        ...


class LaneTrips:
    """Trips along lanes at one speed, of who neither speeds up nor turns: as plans have them.

    Rides last what the building's file says, and never wait.
    """

    def __init__(self, graph: NavigationGraph, speed_m_s: float) -> None:
        self._graph = graph
        self._metres, self._seconds = graph.shortest(speed_m_s)

    def trip(self, origin: str, destination: str) -> Trip:
        """One stage, also across floors."""
        ends = self._graph.index(origin), self._graph.index(destination)
        return [TripStage(float(self._seconds[ends]), float(self._metres[ends]))]
