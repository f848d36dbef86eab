"""A judged drive as a picture: both tracks on the map, and where the other was lost."""

from pathlib import Path

import numpy as np

from mend.localization.judging.verdict import Judgement, Standing
from mend.localization.pictures.canvas import Canvas, Svg, drawn
from mend.localization.pictures.colors import JUDGED, LOST, MAP, NEITHER, TRAJECTORY, Color
from mend.localization.pictures.view import MapView, ends_of, view_of
from mend.maps.vector_map import VectorMap

_PICTURE_PX = 1600
_COLORS: dict[Standing, Color] = {Standing.LOST: LOST, Standing.NEITHER: NEITHER}


def save_judged(judgement: Judgement, vector_map: VectorMap, title: str, path: Path) -> None:
    """Draw a judged drive as `.png` or `.svg`. Raises `UnavailableError`, or `OSError`."""
    view = _view(judgement, vector_map)
    with drawn(path, view.width_px, view.height_px) as canvas:
        _draw(canvas, view, judgement, vector_map, title)


def judged_svg(judgement: Judgement, vector_map: VectorMap, title: str) -> str:
    """The same picture as SVG, to be put into a page."""
    view = _view(judgement, vector_map)
    svg = Svg(view.width_px, view.height_px)
    _draw(svg, view, judgement, vector_map, title)
    return svg.document()


def _view(judgement: Judgement, vector_map: VectorMap) -> MapView:
    seen = [vector_map.segments.reshape(-1, 2), judgement.ours[:, :2], judgement.theirs[:, :2]]
    return view_of(np.vstack(seen), _PICTURE_PX)


def _draw(
    canvas: Canvas, view: MapView, judgement: Judgement, vector_map: VectorMap, title: str
) -> None:
    canvas.segments(view.pixels(ends_of(vector_map)).reshape(-1, 4), MAP)
    canvas.path(view.pixels(judgement.ours[:, :2]), TRAJECTORY, 2.0)
    told = judgement.theirs[np.isfinite(judgement.theirs).all(axis=1), :2]
    canvas.path(view.pixels(told), JUDGED, 2.0)
    for number, stretch in enumerate(judgement.stretches, start=1):
        first = stretch.since.step - judgement.first_step
        last = len(judgement.theirs) - 1
        if stretch.until is not None:
            last = stretch.until.step - judgement.first_step
        color = _COLORS[stretch.standing]
        part = judgement.theirs[first : last + 1, :2]
        canvas.path(view.pixels(part[np.isfinite(part).all(axis=1)]), color, 3.0)
        start = view.pixels(stretch.since.theirs[:2])
        canvas.dots(start[None], color, 5.0)
        canvas.text(float(start[0]) + 8.0, float(start[1]) - 6.0, str(number), color)
    _draw_legend(canvas, title)


def _draw_legend(canvas: Canvas, title: str) -> None:
    entries = {
        "map": MAP,
        "our track": TRAJECTORY,
        "judged track": JUDGED,
        "lost": LOST,
        "neither fits": NEITHER,
    }
    x = 8.0
    for name, color in entries.items():
        canvas.dots(np.array([[x + 4, 14.0]]), color, 4.0)
        canvas.text(x + 14, 18, name)
        x += 30.0 + 8.0 * len(name)
    canvas.text(x + 20, 18, title)
