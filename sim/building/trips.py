"""How long the robots of a building take from place to place if nothing holds them up."""

from mend.maps.building.building import Building
from mend.maps.building.trip import Trip
from mend.robots.base.body import BasePose
from mend.robots.base.trip_time import TripTime
from mend.robots.execution.command_error import CommandError
from mend.sim.building.building_robot import LIMITS, PERIOD_S, RADIUS_M
from mend.sim.building.scene import NEEDS_M, where_to_stand


class BuildingTrips:
    """Trips between the places of a building, `FLOOR/PLACE`; each is computed once."""

    def __init__(self, building: Building) -> None:
        self._building = building
        self._time = TripTime(building, LIMITS, RADIUS_M, NEEDS_M, PERIOD_S)
        self._known: dict[tuple[str, str], Trip] = {}

    def trip(self, origin: str, destination: str) -> Trip:
        """From standing at a place to standing at another, facing as robots do there.

        At an elevator robots stand where they wait for it. Raises `CommandError` where there is no
        way, and where there is no room to wait.
        """
        if (origin, destination) not in self._known:
            here, to = self._pose(origin), self._pose(destination)
            self._known[origin, destination] = self._time.trip(here, to)
        return self._known[origin, destination]

    def _pose(self, name: str) -> BasePose:
        pose = where_to_stand(self._building, name)
        if pose is None:
            raise CommandError(f"there is no room to wait at {name}")
        return BasePose(pose.x, pose.y, pose.yaw, pose.z or 0.0)
