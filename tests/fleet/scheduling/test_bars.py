"""The chart of bars: well-formed, a bar for every number, to the side that its sign says."""

import xml.etree.ElementTree as ET
from math import inf

from mend.fleet.scheduling.drawing.bars import BarGroup, bars

RECT = "{http://www.w3.org/2000/svg}rect"


def drawn(groups: list[BarGroup]) -> list[dict[str, float]]:
    """The bars, without the two rectangles of the legend."""
    root = ET.fromstring(bars("Title <1>", "summary", ("one", "two"), groups))
    numbers = [
        {name: float(each.attrib[name]) for name in ("x", "width")} for each in root.iter(RECT)
    ]
    return numbers[2:]


def test_every_number_has_its_bar_in_proportion() -> None:
    first, second = drawn([BarGroup("row", (10.0, 5.0))])
    assert first["x"] == second["x"]
    assert abs(first["width"] - 2 * second["width"]) <= 0.2


def test_what_is_not_known_or_endless_has_none() -> None:
    assert len(drawn([BarGroup("row", (None, inf)), BarGroup("other", (1.0, None))])) == 1


def test_negative_bars_end_where_positive_ones_begin() -> None:
    plus, minus = drawn([BarGroup("row", (4.0, -4.0))])
    assert abs(minus["x"] + minus["width"] - plus["x"]) <= 0.2
