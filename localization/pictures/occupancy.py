"""A picture to judge extracted lines by: the occupied cells, and the lines over them."""

from pathlib import Path

import numpy as np

from mend.localization.pictures.canvas import drawn
from mend.localization.pictures.colors import CELLS, MAP, REFERENCE
from mend.localization.pictures.view import ends_of, view_of
from mend.maps.occupancy.grid import OccupancyGrid
from mend.maps.vector_map import VectorMap

_PICTURE_PX = 2400
_ROUND = 0.55
"""Of a cell's width: dots that touch each other look like the picture's walls."""


def save_extraction(grid: OccupancyGrid, lines: VectorMap, path: Path) -> None:
    """Draw a grid and its lines as `.png` or `.svg`. Raises `UnavailableError`, or `OSError`."""
    rows, columns = np.nonzero(grid.occupied)
    cells = grid.places(np.column_stack((columns, rows)).astype(np.float64))
    view = view_of(np.vstack((cells, lines.segments.reshape(-1, 2))), _PICTURE_PX)
    radius_px = max(_ROUND * grid.resolution_m * view.scale, 0.5)
    ends = view.pixels(ends_of(lines))
    title = f"{lines.name}: {len(cells)} occupied cells, {len(lines)} lines, "
    with drawn(path, view.width_px, view.height_px) as canvas:
        canvas.dots(view.pixels(cells), CELLS, radius_px)
        canvas.segments(ends.reshape(-1, 4), MAP)
        canvas.dots(ends.reshape(-1, 2), REFERENCE, 1.5)
        canvas.text(8, 18, f"{title}{lines.lengths.sum():.0f} m; their ends are red")
