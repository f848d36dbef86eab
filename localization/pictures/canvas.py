"""What pictures are drawn on: pixels (OpenCV) or SVG; all coordinates are pixels."""

from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.errors import UnavailableError
from mend.localization.pictures.colors import PAPER, TEXT, Color

Matrix = NDArray[np.float64]
Image = NDArray[np.uint8]

_FRACTION_BITS = 4
_FONT_PX = 12


class Canvas(Protocol):
    """Lines, dots and words."""

    def segments(self, rows: Matrix, color: Color) -> None:
        """Lines (n, 4), each from x0, y0 to x1, y1."""
        ...

    def path(self, points: Matrix, color: Color, width: float = 1.0) -> None:
        """One line through points (n, 2)."""
        ...

    def dots(self, points: Matrix, color: Color, radius: float = 1.0) -> None:
        """A dot at each of the points (n, 2)."""
        ...

    def text(self, x: float, y: float, words: str, color: Color = TEXT) -> None: ...


class Raster:
    """A picture of pixels, in OpenCV's order of colours."""

    def __init__(self, width_px: int, height_px: int) -> None:
        self.image: Image = np.full((height_px, width_px, 3), PAPER, dtype=np.uint8)

    def copy(self) -> "Raster":
        other = Raster(1, 1)
        other.image = self.image.copy()
        return other

    def segments(self, rows: Matrix, color: Color) -> None:
        lines = [each.reshape(2, 2) for each in _fixed(rows)]
        cv2.polylines(self.image, lines, False, _bgr(color), 1, cv2.LINE_AA, _FRACTION_BITS)

    def path(self, points: Matrix, color: Color, width: float = 1.0) -> None:
        thickness = max(1, round(width))
        line = [_fixed(points)]
        cv2.polylines(self.image, line, False, _bgr(color), thickness, cv2.LINE_AA, _FRACTION_BITS)

    def dots(self, points: Matrix, color: Color, radius: float = 1.0) -> None:
        size = round(radius * (1 << _FRACTION_BITS))
        for x, y in _fixed(points):
            cv2.circle(
                self.image, (int(x), int(y)), size, _bgr(color), -1, cv2.LINE_AA, _FRACTION_BITS
            )

    def text(self, x: float, y: float, words: str, color: Color = TEXT) -> None:
        at = (round(x), round(y))
        font = cv2.FONT_HERSHEY_SIMPLEX
        cv2.putText(self.image, words, at, font, 0.42, _bgr(color), 1, cv2.LINE_AA)


class Svg:
    """A picture of shapes."""

    def __init__(self, width_px: int, height_px: int) -> None:
        self._size = (width_px, height_px)
        self._shapes: list[str] = []

    def segments(self, rows: Matrix, color: Color) -> None:
        path = "".join(f"M{a:.1f} {b:.1f}L{c:.1f} {d:.1f}" for a, b, c, d in rows)
        self._stroke(path, color, 1.0)

    def path(self, points: Matrix, color: Color, width: float = 1.0) -> None:
        if len(points):
            self._stroke("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points), color, width)

    def dots(self, points: Matrix, color: Color, radius: float = 1.0) -> None:
        # A line of no length with round ends is a dot, and takes a tenth of a circle's text.
        path = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in points)
        self._stroke(path, color, 2.0 * radius)

    def text(self, x: float, y: float, words: str, color: Color = TEXT) -> None:
        self._shapes.append(
            f'<text x="{x:.0f}" y="{y:.0f}" font-family="sans-serif" font-size="{_FONT_PX}" '
            f'fill="rgb{color}">{escape(words)}</text>'
        )

    def document(self) -> str:
        """The whole picture."""
        width, height = self._size
        body = "\n".join(self._shapes)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'width="{width}" height="{height}">\n'
            f'<rect width="100%" height="100%" fill="rgb{PAPER}"/>\n{body}\n</svg>\n'
        )

    def _stroke(self, path: str, color: Color, width: float) -> None:
        self._shapes.append(
            f'<path d="{path}" fill="none" stroke="rgb{color}" stroke-width="{width:g}" '
            'stroke-linecap="round"/>'
        )


@contextmanager
def drawn(path: Path, width_px: int, height_px: int) -> Iterator[Canvas]:
    """A canvas that is written as `.png` or `.svg` once something is drawn on it.

    Raises `UnavailableError`, or `OSError`.
    """
    if path.suffix == ".svg":
        svg = Svg(width_px, height_px)
        yield svg
        path.write_text(svg.document(), encoding="utf-8")
        return
    raster = Raster(width_px, height_px)
    yield raster
    encoded, data = cv2.imencode(".png", raster.image)
    if not encoded:
        raise UnavailableError(f"'{path}' could not be written as a picture")
    path.write_bytes(data.tobytes())


def _fixed(points: Matrix) -> NDArray[np.int32]:
    return np.round(points * (1 << _FRACTION_BITS)).astype(np.int32)


def _bgr(color: Color) -> Color:
    return color[2], color[1], color[0]
