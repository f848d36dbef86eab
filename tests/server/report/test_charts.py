"""Charts show what they are given, whole and readable by those who cannot see them."""

import xml.etree.ElementTree as ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.server.report.charts import (
    BarRow,
    Chart,
    Column,
    DotRow,
    dots,
    round_ticks,
    stacked_bars,
    stacked_columns,
)

SVG = "{http://www.w3.org/2000/svg}"
WORDS = {"a": "apples", "b": "<pears>"}
seconds = st.floats(0.0, 1e5)


def drawn(chart: Chart) -> ElementTree.Element:
    return ElementTree.fromstring(chart.svg)


def widths(chart: Chart, class_: str) -> list[float]:
    boxes = drawn(chart).iter(f"{SVG}rect")
    return [
        float(each.get("width", 0)) for each in boxes if class_ in each.get("class", "").split()
    ]


def test_bars_are_as_long_as_their_values_and_are_said() -> None:
    rows = [BarRow("x & y", "1 leg", {"a": 3.0, "b": 1.0}), BarRow("z", "", {"a": 0.0, "b": 2.0})]
    chart = stacked_bars("Time", rows, WORDS, "min", "Minutes")
    (longest,), (short, middle) = widths(chart, "a"), widths(chart, "b")
    assert longest == pytest.approx(3 * short, abs=0.2)
    assert middle == pytest.approx(2 * short, abs=0.2)
    said = drawn(chart).findtext(f"{SVG}desc") or ""
    assert "x & y, 4.0 min (apples 3.0 min, <pears> 1.0 min)" in said
    assert chart.legend == [("a", "apples"), ("b", "<pears>")]


@given(st.lists(st.fixed_dictionaries({"a": seconds, "b": seconds}), max_size=5))
def test_no_bar_leaves_its_drawing(values: list[dict[str, float]]) -> None:
    rows = [BarRow(f"row {n}", "", each) for n, each in enumerate(values)]
    chart = drawn(stacked_bars("Time", rows, WORDS, "min", "Minutes"))
    width = float(chart.get("viewBox", "").split()[2])
    for each in chart.iter(f"{SVG}rect"):
        assert 0.0 <= float(each.get("x", -1)) <= width
        assert float(each.get("x", 0)) + float(each.get("width", 0)) <= width


@given(st.lists(st.fixed_dictionaries({"a": st.integers(0, 9), "b": st.integers(0, 9)})))
def test_columns_are_as_high_as_their_counts(counts: list[dict[str, int]]) -> None:
    columns = [Column(n, n + 1.0, each) for n, each in enumerate(counts)]
    chart = stacked_columns("Requests", columns, WORDS, "min", "Requests")
    root = drawn(chart)
    total = sum(sum(each.values()) for each in counts)
    boxes = [float(each.get("height", 0)) for each in root.iter(f"{SVG}rect")]
    assert len(boxes) == sum(each > 0 for count in counts for each in count.values())
    if boxes:
        one_px = sum(boxes) / total
        highest_px = max(sum(each.values()) for each in counts) * one_px
        assert 70.0 < highest_px < 200.0


def test_every_dot_says_whose_it_is() -> None:
    rows = [DotRow("transport", {"a": [(1.0, "mail"), (3.0, "keys")], "b": []}, {"a": 2.0})]
    root = drawn(dots("Waiting", rows, WORDS, "min", "Waits"))
    tips = [each.findtext(f"{SVG}title") for each in root.iter(f"{SVG}circle")]
    assert tips == ["mail: apples 1.0 min", "keys: apples 3.0 min"]
    assert "transport apples 2.0 min" in (root.findtext(f"{SVG}desc") or "")


@given(st.floats(0.0, 1e6), st.floats(1e-3, 1e6), st.integers(2, 30))
def test_ticks_are_few_and_between_the_ends(first: float, span: float, about: int) -> None:
    ticks = list(round_ticks(first, first + span, about))
    assert len(ticks) <= about + 1
    near = 1e-9 * (1.0 + first + span)
    assert all(first - near <= each <= first + span + near for each in ticks)
