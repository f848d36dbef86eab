"""The elevators of a building in discrete events: one robot at a time, first come, first served."""

from dataclasses import dataclass

from mend.maps.building.building import Building
from mend.maps.building.cabin import CABIN_DOOR_S
from mend.maps.building.trip import TripRide


@dataclass(frozen=True, slots=True)
class RideTimes:
    """How long a ride takes (seconds): until the cabin is open, and until it is there."""

    waits_s: float
    rides_s: float


@dataclass(slots=True)
class _Cabin:
    """Where it is, or will be, shut, at `free_s`."""

    floor: str
    free_s: float = 0.0


class Cabins:
    """Where the cabins are; whoever calls first has one until they are out of it."""

    def __init__(self, building: Building) -> None:
        self._plans, self._order = building.document.elevators, list(building.floors)
        self._cabins = {
            name: _Cabin(min(plan.stops, key=self._order.index))
            for name, plan in self._plans.items()
        }

    def take(self, ride: TripRide, called_s: float) -> RideTimes:
        """Have a robot ride that waits at the cabin since a time; nobody may have called later."""
        cabin = self._cabins[ride.elevator]
        leaves_s = max(called_s, cabin.free_s)
        opens_s = leaves_s + self._moves_s(ride.elevator, cabin.floor, ride.from_floor)
        moves_s = self._moves_s(ride.elevator, ride.from_floor, ride.to_floor)
        # A door that has begun to open opens before it shuts.
        shuts_s = opens_s + max(ride.gets_in_s, CABIN_DOOR_S)
        there_s = shuts_s + CABIN_DOOR_S + moves_s
        cabin.floor = ride.to_floor
        cabin.free_s = there_s + max(ride.gets_out_s, CABIN_DOOR_S) + CABIN_DOOR_S
        return RideTimes(opens_s - called_s, there_s - opens_s)

    def _moves_s(self, elevator: str, begin: str, end: str) -> float:
        floors = abs(self._order.index(begin) - self._order.index(end))
        return floors * self._plans[elevator].floor_s
