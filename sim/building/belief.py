"""Where a robot of a building believes that it is: a floor, and a pose by laser and wheels."""

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from mend.documents.strict_model import StrictModel
from mend.localization.enml.localizer import EnmlLocalizer
from mend.localization.localizer import SearchingLocalizer
from mend.localization.pose import Poses
from mend.maps.building.building import Building, Floor
from mend.maps.vector_map import VectorMap
from mend.robots.base.body import RangeScan
from mend.robots.base.localized_pose import LocalizedPose
from mend.robots.base.place_names import PlaceNames
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.odometry import Odometer

Point = tuple[float, float]


class BeliefSnapshot(StrictModel):
    """What a robot goes on believing: floor, x, y, yaw; and whether it is lost."""

    at: tuple[str, float, float, float]
    is_lost: bool


class FloorMap:
    """What robots know of one floor; what the maps of all of them share is made once."""

    def __init__(self, floor: Floor, places: Mapping[str, Point]) -> None:
        self._floor = floor
        self.names = PlaceNames(places, floor.vector_map.segments)

    def localizer(self) -> SearchingLocalizer:
        """One that follows a robot by the walls: doors stand open, or are shut."""
        return EnmlLocalizer(self._walls, may_be_at=self._floor.has_way_from)

    @cached_property
    def _walls(self) -> VectorMap:
        return VectorMap.of(self._floor.walls)


def floor_maps(
    building: Building, places: Mapping[str, Mapping[str, Point]]
) -> Mapping[str, FloorMap]:
    """The maps of all floors; `places` by floor and by what people call them."""
    return {name: FloorMap(each, places.get(name, {})) for name, each in building.floors.items()}


class Belief:
    """What one robot believes. It knows which floor it is on; it says so when that changes."""

    def __init__(self, maps: Mapping[str, FloorMap], at: FloorPose, odometer: Odometer) -> None:
        self._maps = maps
        self._odometer = odometer
        self._floor = at.floor
        there = maps[at.floor]
        self.whereabouts = LocalizedPose(
            there.localizer(), there.names.name_of, _flat(at), self._wheels
        )

    @property
    def at(self) -> FloorPose:
        """Where it believes to be now."""
        x, y, yaw = self.whereabouts.pose(self._wheels).tolist()
        return FloorPose(self._floor, x, y, yaw)

    def see(self, scan: RangeScan) -> None:
        """Take a scan that was made just now."""
        self.whereabouts.note(self._wheels, scan)

    def needs_scan_s(self) -> float:
        """When it needs the next scan, unless it drives; in the past where it needs one now."""
        return self.whereabouts.due_s(self._wheels)

    def enter(self, floor: str, shift: tuple[float, float] = (0.0, 0.0)) -> None:
        """From now on it is on another floor, so much shifted (metres), or on the same one."""
        if floor == self._floor and shift == (0.0, 0.0):
            return
        there, at = self._maps[floor], _flat(self.at) + np.array([*shift, 0.0])
        self._floor = floor
        self.whereabouts.change_map(there.localizer(), there.names.name_of, at, self._wheels)

    def snapshot(self) -> BeliefSnapshot:
        """What `restore` goes on from."""
        at = self.at
        return BeliefSnapshot(at=(at.floor, at.x, at.y, at.yaw), is_lost=self.whereabouts.is_lost)

    def restore(self, kept: BeliefSnapshot) -> None:
        """Go on from there, with the odometer as it is now. Raises `ValueError`."""
        at = FloorPose(*kept.at)
        if at.floor not in self._maps:
            raise ValueError(f"the snapshot has a robot on '{at.floor}', which there is not")
        if at.floor != self._floor:
            self.enter(at.floor)
        self.whereabouts.start_anew(_flat(at), self._wheels, lost=kept.is_lost)

    @property
    def _wheels(self) -> Poses:
        return np.array(self._odometer.pose)


def _flat(at: FloorPose) -> Poses:
    return np.array([at.x, at.y, at.yaw])
