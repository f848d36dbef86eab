"""Who is in a building: robots and people, round as seen from above."""

from dataclasses import dataclass, field

from mend.sim.building.building_robot import BuildingRobot
from mend.sim.building.bystander import RADIUS_M, Bystander
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.guest import Guest
from mend.sim.building.guests import Guests
from mend.sim.building.walkers import Walker, Walkers

Circle = tuple[float, float, float]


@dataclass(slots=True)
class Crowd:
    """Robots, and people who stand in a way, walk about, or are escorted."""

    walkers: Walkers
    guests: Guests
    robots: list[BuildingRobot] = field(default_factory=list)
    bystanders: list[Bystander] = field(default_factory=list)

    def circles(self, floor: str, but: BuildingRobot | None = None) -> list[Circle]:
        """All who are on a floor: x, y and radius (metres)."""
        there = [(e.at, e.radius_m) for e in self.robots if e is not but]
        there += [(each.at, RADIUS_M) for each in self._people()]
        return [(at.x, at.y, radius) for at, radius in there if at.floor == floor]

    def people(self, floor: str, but: Guest) -> list[FloorPose]:
        """Where people are on a floor."""
        return [e.at for e in self._people() if e is not but and e.at.floor == floor]

    def standing(self) -> list[FloorPose]:
        """Where those are round whom others walk, robots apart."""
        bystanders = [each.at for each in self.bystanders]
        return bystanders + [each.at for each in self.guests.there.values()]

    def _people(self) -> list[Bystander | Walker | Guest]:
        people: list[Bystander | Walker | Guest] = [*self.bystanders, *self.walkers.people]
        people += self.guests.there.values()
        return people
