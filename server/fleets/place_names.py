"""The places of a building as the tasks of a scene call them, and back."""

import math
from collections.abc import Iterator, Mapping, Sequence

from mend.errors import WrongInputError
from mend.maps.building.building import Building
from mend.maps.building.cabin import waiting_points
from mend.sim.building.scene import NEEDS_M
from mend.tasks.scene import Scene

SAME_M = 0.05
"""A place of a scene is one of the building's if it is not farther from it."""
BESIDE_M = 1.0
"""Two robots have room beside each other that stand so far apart."""


class PlaceNames:
    """Between `FLOOR/PLACE`, as requests and plans have it, and the names in one scene."""

    def __init__(self, building: Building, scene: Scene) -> None:
        self._building = building
        self._called = dict(_called(building, scene))

    @property
    def names(self) -> list[str]:
        """All places that tasks may name, as `FLOOR/PLACE`."""
        return list(self._called)

    def in_scene(self, place: str) -> str:
        """What tasks call a place. Raises `NotFoundError`, or `WrongInputError` for no goal."""
        full = self._building.find(place)
        if full not in self._called:
            raise WrongInputError(
                f"robots are not sent to '{full}': the scene names no place there"
            )
        return self._called[full]

    def home(self, start: str) -> str:
        """Where a robot is sent that goes back to its first place: there, or as near as it can."""
        full = self._building.find(start)
        floor, name = full.split("/", 1)
        at = self._building.floors[floor].places[name]
        away = self._away_m(at.x, at.y, self._building.floors[floor].height)
        return min(((m, each) for m, each in away if each in self._called), default=(0.0, full))[1]

    def nearest(self, x: float, y: float, z: float) -> str | None:
        """The place that is nearest to a position of the scene; between floors that of them all."""
        away = self._away_m(x, y, z) or self._away_between_floors_m(x, y, z)
        return min(away, default=(0.0, None))[1]

    def beside(self, x: float, y: float, z: float) -> str | None:
        """The nearest place that robots are sent to, and that one at a position leaves free."""
        return next(iter(self.around(x, y, z)), None)

    def around(self, x: float, y: float, z: float) -> list[str]:
        """All places of a floor that robots are sent to, and that one there leaves free,
        the nearest first."""
        free = (e for e in self._away_m(x, y, z) if e[0] >= BESIDE_M and e[1] in self._called)
        return [each for _, each in sorted(free)]

    def away_m(self, place: str, x: float, y: float, z: float) -> float | None:
        """How far a position of the scene is from a place of the same floor; None from others."""
        full = self._building.find(place)
        return next((each for each, name in self._away_m(x, y, z) if name == full), None)

    def _away_m(self, x: float, y: float, z: float) -> list[tuple[float, str]]:
        """How far each place of the floor is, and what it is called."""
        floor = self._building.floor_at(z)
        if floor is None:
            return []
        places = self._building.floors[floor].places
        return [
            (math.hypot(each.x - x, each.y - y), f"{floor}/{name}") for name, each in places.items()
        ]

    def _away_between_floors_m(self, x: float, y: float, z: float) -> list[tuple[float, str]]:
        return [
            (math.dist((each.x, each.y, on.height), (x, y, z)), f"{floor}/{name}")
            for floor, on in self._building.floors.items()
            for name, each in on.places.items()
        ]


def _called(building: Building, scene: Scene) -> Iterator[tuple[str, str]]:
    stood_at = {floor: _stood_at(building, floor) for floor in building.floors}
    for name, place in scene.places.items():
        at = place.pose
        floor = building.floor_at(at.z or 0.0)
        if floor is None:
            continue
        for each, points in stood_at[floor].items():
            if any(math.hypot(at.x - x, at.y - y) < SAME_M for x, y in points):
                yield f"{floor}/{each}", name


def _stood_at(building: Building, floor: str) -> Mapping[str, Sequence[tuple[float, float]]]:
    """Where robots stand that are sent to a place: at an elevator before it."""
    on = building.floors[floor]
    stops = {each.stops.get(floor) for each in building.document.elevators.values()}
    return {
        name: waiting_points(on, (each.x, each.y), NEEDS_M) if name in stops else [(each.x, each.y)]
        for name, each in on.places.items()
    }
