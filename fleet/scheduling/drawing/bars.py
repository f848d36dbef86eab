"""Bars side by side: a group of them per row, one per series; for figures of benchmarks."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from mend.maps.svg import Svg, color, text_width_px

BAR_PX = 9.0
GAP_PX = 8.0
WIDTH_PX = 900.0


@dataclass(frozen=True, slots=True)
class BarGroup:
    """What is written left of a row, and one number for each series (None: there is none)."""

    name: str
    values: tuple[float | None, ...]


def bars(title: str, summary: str, series: Sequence[str], groups: Sequence[BarGroup]) -> str:
    """The chart as SVG. Negative numbers go to the left; what is not finite is left out."""
    svg = Svg()
    svg.text(16, 28, title, "title")
    svg.text(16, 46, summary, "soft")
    x = 16.0
    for number, name in enumerate(series):
        svg.add("rect", x=x, y=58, width=10, height=10, fill=color(number))
        svg.text(x + 15, 67, name)
        x += 30 + text_width_px(name)
    known = [
        each for group in groups for each in group.values if each is not None and isfinite(each)
    ]
    low, high = min([0.0, *known]), max([0.0, *known])
    left = 28 + max((text_width_px(group.name) for group in groups), default=0.0)
    scale = (WIDTH_PX - left - 80) / ((high - low) or 1.0)
    zero = left + (40 if low < 0 else 0) - low * scale
    y = 84.0
    for group in groups:
        height = BAR_PX * len(series)
        svg.text(16, y + height / 2 + 4, group.name, "name")
        for number, value in enumerate(group.values):
            if value is not None and isfinite(value):
                _draw_bar(svg, zero, y + BAR_PX * number, value, scale, color(number))
        y += height + GAP_PX
    svg.add("path", d=f"M{zero:.1f} 78V{y - GAP_PX:.1f}", class_="grid")
    return svg.document(WIDTH_PX, y + 8, f"{title}: {summary}")


def _draw_bar(svg: Svg, zero: float, y: float, value: float, scale: float, fill: str) -> None:
    length = abs(value) * scale
    x = zero if value >= 0 else zero - length
    svg.add("rect", x=x, y=y, width=max(length, 0.5), height=BAR_PX - 1.5, fill=fill)
    if value >= 0:
        svg.text(x + length + 4, y + BAR_PX - 1.5, f"{value:.1f}", "soft")
    else:
        svg.text(x - 4, y + BAR_PX - 1.5, f"{value:.1f}", "soft end")
