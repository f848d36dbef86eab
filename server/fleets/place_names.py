"""The places of a building as the tasks of a scene call them, and back."""

import math
from collections.abc import Iterator

from mend.errors import WrongInputError
from mend.maps.building.building import Building
from mend.tasks.scene import Scene

SAME_M = 0.05
"""A place of a scene is one of the building's if it is not farther from it."""


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

    def nearest(self, x: float, y: float, z: float, *, of_goals: bool = False) -> str | None:
        """The place that is nearest to a position of the scene; None where there is no floor.

        `of_goals`: of those that robots are sent to.
        """
        floor = self._building.floor_at(z)
        if floor is None:
            return None
        places = self._building.floors[floor].places
        named = [n for n in places if not of_goals or f"{floor}/{n}" in self._called]
        if not named:
            return None
        nearest = min(named, key=lambda n: math.hypot(places[n].x - x, places[n].y - y))
        return f"{floor}/{nearest}"


def _called(building: Building, scene: Scene) -> Iterator[tuple[str, str]]:
    for name, place in scene.places.items():
        at = place.pose
        floor = building.floor_at(at.z or 0.0)
        if floor is None:
            continue
        for each, there in building.floors[floor].places.items():
            if math.hypot(at.x - there.x, at.y - there.y) < SAME_M:
                yield f"{floor}/{each}", name
