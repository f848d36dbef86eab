"""How long robots take from place to place: what legs in discrete events are driven by."""

from typing import Protocol

from mend.fleet.scheduling.building_travel import travel_in
from mend.maps.building.trip import Trip, TripStage
from mend.maps.navigation import NavigationGraph


class TripTimes(Protocol):
    """Trips of a robot of speed 1 if nothing holds it up."""

    def trip(self, origin: str, destination: str) -> Trip:
        """From standing at a place, `FLOOR/PLACE`, to standing at another."""
        ...


class LaneTrips:
    """Trips as plans have them: along lanes at one speed, `starts_s` more for each.

    Rides last what the building's file says, and never wait.
    """

    def __init__(self, graph: NavigationGraph, speed_m_s: float, starts_s: float = 0.0) -> None:
        self._graph = graph
        self._travel = travel_in(graph, speed_m_s, starts_s=starts_s)

    def trip(self, origin: str, destination: str) -> Trip:
        """One stage, also across floors."""
        ends = self._graph.index(origin), self._graph.index(destination)
        seconds, metres = self._travel.time_s[ends], self._travel.distance_m[ends]
        return [TripStage(float(seconds), float(metres))]
