"""The doors of a building's world: which are shut, and who is near enough to open them."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building, Door
from mend.maps.building.clearance import apart_m
from mend.sim.building.door import NOTICES_M, WorldDoor

Matrix = NDArray[np.float64]
Circle = tuple[float, float, float]
Point = tuple[float, float]
_NONE: Matrix = np.zeros((0, 4))


class WorldDoors(Mapping[str, WorldDoor]):
    """The doors of all floors, by `FLOOR/DOOR`."""

    def __init__(self, building: Building, is_shut: Callable[[Door], bool]) -> None:
        """`is_shut` says it of each once, in the order of the building's file."""
        self._on: dict[str, list[WorldDoor]] = {
            floor: [
                WorldDoor(f"{floor}/{name}", plan, is_shut(plan))
                for name, plan in each.doors.items()
            ]
            for floor, each in building.floors.items()
        }
        self._segments = {
            floor: np.array([each.segment for each in doors], np.float64).reshape(-1, 4)
            for floor, doors in self._on.items()
        }
        self._noticed: dict[str, tuple[tuple[Point, ...], list[bool]]] = {}
        self._shut: dict[str, tuple[list[bool], Matrix]] = {}
        self._by_name = {each.name: each for doors in self._on.values() for each in doors}

    def __getitem__(self, name: str) -> WorldDoor:
        return self._by_name[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._by_name)

    def let_pass(self, time_s: float, circles: Callable[[str], Sequence[Circle]]) -> None:
        """One cycle: they open for who comes, and fall shut behind them."""
        for floor, doors in self._on.items():
            heeding = [number for number, each in enumerate(doors) if each.heeds_who_comes]
            if not heeding:
                continue
            near = self._near(floor, circles(floor))
            for number in heeding:
                doors[number].let_pass(time_s, somebody=near[number])

    def changes_s(self, time_s: float) -> float:
        """When the next one may open or shut by the clock alone; infinite if none does."""
        times_s = (
            at_s for doors in self._on.values() for each in doors for at_s in each.changes_s()
        )
        return min((each for each in times_s if each > time_s), default=math.inf)

    def _near(self, floor: str, there: Sequence[Circle]) -> list[bool]:
        """Before which doors of a floor somebody is; computed anew once they have moved."""
        before, near = self._noticed.get(floor, ((), []))
        now = tuple((x, y) for x, y, _ in there)
        if before != now or not near:
            segments = self._segments[floor]
            away_m = np.full(len(segments), math.inf)
            if now:
                away_m = apart_m(np.array(now), segments).min(axis=0)
            near = (away_m < NOTICES_M).tolist()
            self._noticed[floor] = now, near
        return near

    def shut(self, floor: str) -> Matrix:
        """The lines (n, 4) between the posts of those that are shut on a floor."""
        if floor not in self._on:
            return _NONE
        is_shut = [each.is_shut for each in self._on[floor]]
        before, segments = self._shut.get(floor, ([], _NONE))
        if before != is_shut:
            segments = np.asarray(self._segments[floor][is_shut])
            self._shut[floor] = is_shut, segments
        return segments

    def nearest_shut(
        self, floor: str, x: float, y: float, time_s: float
    ) -> tuple[float, WorldDoor] | None:
        """The shut one that is nearest to a point, and may be opened now; how far, in metres."""
        doors = self._on.get(floor, [])
        may_open = [
            (each.distance_m(x, y), number)
            for number, each in enumerate(doors)
            if each.is_shut and each.may_be_passed(time_s)
        ]
        if not may_open:
            return None
        away_m, number = min(may_open)
        return away_m, doors[number]

    def is_kept_shut(self, floor: str, x: float, y: float, within_m: float, time_s: float) -> bool:
        """Whether a door so near to a point is shut, and nobody may open it now."""
        return any(
            each.is_shut and not each.may_be_passed(time_s) and each.distance_m(x, y) < within_m
            for each in self._on.get(floor, [])
        )
