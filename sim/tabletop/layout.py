"""Laying out whatever objects and places a task tree names, where no scene file describes them."""

import colorsys
import math
from collections.abc import Iterable

import numpy as np

from mend.errors import WrongInputError
from mend.tasks.scene import Place, Pose, Scene, SceneObject, Table

MOST_OBJECTS = 64
"""So many colours survive shading and are still told apart by hue and saturation."""

_HUES = 16
_SATURATIONS = (1.0, 0.8, 0.6, 0.4)
_VALUE = 0.9
_SIZES = ((0.075, 0.050, 0.050), (0.068, 0.050, 0.050))
"""Neighbours in colour differ in size as well, so that cameras with noise tell them apart."""
_CELL_M = 0.105
_NEAR_EDGE_M = 0.35
_MIDDLE_Y_M = -0.19
_TURN_RAD = 0.4
_ASPECT = 1.5
"""Each half of the table is so much longer away from the robot than it is wide."""


def lay_out(names: Iterable[tuple[str, str | None]], seed: int) -> Scene:
    """Make up a scene for (object, place) names, objects on the right, places on the left.

    Raises `WrongInputError` for more objects or places than the table has room and colours for.
    """
    pairs = list(names)
    objects = list(dict.fromkeys(name for name, _ in pairs))
    places = list(dict.fromkeys(place for _, place in pairs if place is not None))
    for kind, found in (("objects", objects), ("places", places)):
        if len(found) > MOST_OBJECTS:
            raise WrongInputError(
                f"a tabletop holds at most {MOST_OBJECTS} {kind}, this tree names {len(found)}"
            )
    rng = np.random.default_rng(seed)
    grid = _Grid(max(len(objects), len(places), 1))
    starts = rng.permutation(grid.cells)
    # The farthest cell is always a place: the robot reaches as far as its places.
    targets = [grid.cells - 1, *rng.permutation(grid.cells - 1)]
    turns = rng.uniform(-_TURN_RAD, _TURN_RAD, len(objects))
    return Scene(
        name="laid_out",
        table=grid.table(),
        objects={
            name: SceneObject(
                color=color,
                size=_SIZES[number % len(_SIZES)],
                pose=grid.pose(int(cell), right=True, yaw=float(turn)),
            )
            for number, (name, color, cell, turn) in enumerate(
                zip(objects, distinct_colors(len(objects)), starts, turns, strict=False)
            )
        },
        places={
            name: Place(pose=grid.pose(int(cell), right=False))
            for name, cell in zip(places, targets, strict=False)
        },
    )


def distinct_colors(count: int) -> list[tuple[float, float, float]]:
    """Up to `MOST_OBJECTS` colours, as far apart in hue and saturation as their number allows."""
    levels = max(1, math.ceil(count / _HUES))
    hues = max(1, math.ceil(count / levels))
    colors = [
        colorsys.hsv_to_rgb(hue / hues, saturation, _VALUE)
        for saturation in _SATURATIONS[:levels]
        for hue in range(hues)
    ]
    return colors[:count]


class _Grid:
    """Two equal grids of cells, one on each half of the table, numbered from the robot away."""

    def __init__(self, cells: int) -> None:
        self._columns = max(1, math.ceil(math.sqrt(cells / _ASPECT)))
        self._rows = math.ceil(cells / self._columns)
        self.cells = self._rows * self._columns

    def table(self) -> Table:
        depth, width = (self._rows + 1) * _CELL_M, (2 * self._columns + 2) * _CELL_M
        return Table(center=(_NEAR_EDGE_M + depth / 2, _MIDDLE_Y_M), size=(depth, width))

    def pose(self, cell: int, *, right: bool, yaw: float = 0.0) -> Pose:
        row, column = divmod(cell, self._columns)
        aside = (column + 1) * _CELL_M
        return Pose(
            x=_NEAR_EDGE_M + (row + 1) * _CELL_M,
            y=_MIDDLE_Y_M - aside if right else _MIDDLE_Y_M + aside,
            yaw=yaw,
        )
