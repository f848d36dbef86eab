"""Reads a floor's map: a vector map, or an occupancy map whose lines are then extracted."""

from dataclasses import dataclass
from pathlib import Path

from mend.maps.occupancy.grid import OccupancyGrid
from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map

OCCUPANCY_SUFFIXES = (".yaml", ".yml")


@dataclass(frozen=True, slots=True, eq=False)
class FloorMap:
    """A vector map, and where the walls of the picture are that it was extracted from, if any."""

    lines: VectorMap
    picture: OccupancyGrid | None = None


def read_map(path: Path) -> FloorMap:
    """The map of a `.txt`, `.json`, or Nav2 `.yaml` file. Raises `WrongInputError`, `OSError`."""
    if path.suffix not in OCCUPANCY_SUFFIXES:
        return FloorMap(read_vector_map(path))
    from mend.maps.occupancy.lines import lines_of
    from mend.maps.occupancy.nav2_file import read_occupancy_grid

    grid = read_occupancy_grid(path)
    return FloorMap(lines_of(grid), grid)
