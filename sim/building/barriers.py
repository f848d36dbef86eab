"""Ways that somebody has barred: a door is locked, or things stand right across a corridor."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building, LaneCrossing
from mend.maps.building.clearance import distances_m
from mend.maps.building.right_across import right_across
from mend.sim.building.doors import WorldDoors
from mend.sim.building.stacked import StackedRows

Matrix = NDArray[np.float64]
Lane = tuple[str, str]


class Barriers:
    """What bars lanes, by the places at their ends, until somebody clears them again."""

    def __init__(self, building: Building, doors: WorldDoors) -> None:
        self._building, self._doors = building, doors
        self._across: dict[frozenset[str], tuple[str, Matrix]] = {}
        self._stacked = StackedRows()
        self._locked: dict[frozenset[str], Sequence[str]] = {}

    def bar(self, lane: Lane) -> tuple[str, Matrix] | None:
        """Lock the doors on a lane; where it has none, what is put across it (1, 4), on its floor.

        Raises `ValueError` where there is no such lane, or it is barred already.
        """
        key, crossing = frozenset(lane), self._lane(lane)
        if key in self._across or key in self._locked:
            raise ValueError(f"the way between {lane[0]} and {lane[1]} is barred already")
        if crossing.doors:
            names = self._locked[key] = [f"{crossing.floor}/{name}" for name in crossing.doors]
            for name in names:
                self._doors[name].lock()
            return None
        floor = self._building.floors[crossing.floor]
        self._across[key] = crossing.floor, right_across(floor, crossing.lane)[0]
        return self._across[key]

    def clear(self, lane: Lane) -> None:
        """Have it free again. Raises `ValueError` where nothing bars it."""
        key = frozenset(lane)
        if self._across.pop(key, None) is not None:
            return
        names = self._locked.pop(key, None)
        if names is None:
            raise ValueError(f"nothing bars the way between {lane[0]} and {lane[1]}")
        for name in names:
            self._doors[name].unlock()

    def segments(self, floor: str) -> Matrix:
        """What stands across corridors of a floor (n, 4)."""
        there = [each for on, each in self._across.values() if on == floor]
        return self._stacked.of(floor, there)

    def is_near(self, floor: str, x: float, y: float, within_m: float) -> bool:
        """Whether something stands across a corridor so near to a point."""
        return bool(distances_m(np.array([[x, y]]), self.segments(floor))[0] < within_m)

    def snapshot(self) -> list[Lane]:
        """The lanes that are barred."""
        return [(min(key), max(key)) for key in (*self._across, *self._locked)]

    def restore(self, lanes: Sequence[Lane]) -> None:
        """Have these barred, and no others. Raises `ValueError`."""
        for each in self.snapshot():
            self.clear(each)
        for each in lanes:
            self.bar(each)

    # --- Within -------------------------------------------------------------------------------

    def _lane(self, lane: Lane) -> LaneCrossing:
        wanted = frozenset(lane)
        for each in self._building.crossings:
            if wanted == {f"{each.floor}/{end}" for end in each.lane.between}:
                return each
        raise ValueError(f"no lane leads between {lane[0]} and {lane[1]}")
