"""Plain charts as SVG, to stand in a page that styles them: bars, columns and dots on one axis."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import floor, log10

from mend.maps.svg import Svg, text_width_px

WIDTH_PX = 1040.0
_RIGHT_PX = 70.0
_TOP_PX = 26.0
_BAR_PX = 26.0
_ROW_PX = 42.0
_VALUE_PX = 30.0
"""What is narrower has no figure written on it."""
_COLUMNS_PX = 190.0


@dataclass(frozen=True, slots=True)
class Chart:
    """A drawing, and what its colours and marks mean: classes and words."""

    svg: str
    legend: Sequence[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class TimeUnit:
    """What long and short times are read in."""

    word: str
    seconds: float

    @classmethod
    def of(cls, lasts_s: float) -> "TimeUnit":
        """Minutes from ten of them on, hours from six."""
        if lasts_s >= 6 * 3600.0:
            return cls("h", 3600.0)
        return cls("min", 60.0) if lasts_s >= 600.0 else cls("s", 1.0)


@dataclass(frozen=True, slots=True)
class Axis:
    """What is measured from left to right; `per_tick`: how much of it a tick's unit is."""

    left_px: float
    right_px: float
    first: float
    last: float
    per_tick: float = 1.0

    def x(self, value: float) -> float:
        """Where a value is."""
        span = (self.last - self.first) or 1.0
        return self.left_px + (self.right_px - self.left_px) * (value - self.first) / span

    def draw(self, svg: Svg, bottom: float, unit: str, ticks: int = 8) -> None:
        """Grid lines with their values above them."""
        per = self.per_tick
        for value in round_ticks(self.first / per, self.last / per, ticks):
            x = self.x(value * per)
            svg.add("line", x1=x, x2=x, y1=_TOP_PX - 6, y2=bottom, class_="grid")
            svg.text(x, _TOP_PX - 11, f"{value:g} {unit}", "soft middle")


def axis_for(labels: Sequence[str], first: float, last: float, width_px: float = WIDTH_PX) -> Axis:
    """An axis beside labels."""
    left = 26 + max((text_width_px(each) for each in labels), default=0.0)
    return Axis(left, width_px - _RIGHT_PX, first, last)


def round_ticks(first: float, last: float, about: int) -> Iterator[float]:
    """Round values between two."""
    step = round_step(max(last - first, 1e-9) / about)
    number = -floor(-first / step)
    while number * step <= last:
        yield number * step
        number += 1


def round_step(about: float) -> float:
    """1, 2 or 5 times a power of ten, from `about` on."""
    power: float = 10.0 ** floor(log10(about))
    return next(power * each for each in (1, 2, 5, 10) if power * each >= about * (1 - 1e-9))


@dataclass(frozen=True, slots=True)
class BarRow:
    """One stacked bar: values by class, in their order; `detail` is said in smaller letters."""

    label: str
    detail: str
    values: Mapping[str, float]


def stacked_bars(
    title: str, rows: Sequence[BarRow], words: Mapping[str, str], unit: str, about: str
) -> Chart:
    """A bar a row; `words` say what classes mean, `about` what the bars are."""
    totals = [sum(row.values.values()) for row in rows]
    labels = [each for row in rows for each in (row.label, row.detail)]
    axis = axis_for(labels, 0.0, max(totals, default=0.0) or 1.0)
    svg, bottom = Svg(), _TOP_PX + _ROW_PX * len(rows)
    axis.draw(svg, bottom, unit)
    for number, (row, total) in enumerate(zip(rows, totals, strict=True)):
        y = _TOP_PX + _ROW_PX * number + 6
        svg.text(0, y + 11, row.label, "name")
        svg.text(0, y + 25, row.detail, "soft")
        done = 0.0
        for class_, value in row.values.items():
            _segment(svg, axis, (done, value), y, class_, f"{words[class_]}: {value:.1f} {unit}")
            done += value
        svg.text(axis.x(total) + 6, y + 17, f"{total:.1f} {unit}", "halo")
    said = [
        f"{row.label}, {total:.1f} {unit} ({_parts(row, words, unit)})"
        for row, total in zip(rows, totals, strict=True)
    ]
    seen = [each for each in words if any(row.values.get(each) for row in rows)]
    return Chart(
        svg.figure(WIDTH_PX, bottom + 4, title, f"{about}. {'; '.join(said)}."),
        [(each, words[each]) for each in seen],
    )


def _segment(
    svg: Svg, axis: Axis, part: tuple[float, float], y: float, class_: str, tip: str
) -> None:
    begin, value = part
    x, width = axis.x(begin), axis.x(begin + value) - axis.x(begin)
    if width <= 0.0:
        return
    _box(svg, (x, y, width, _BAR_PX), class_, tip)
    if width >= _VALUE_PX:
        svg.text(x + width / 2, y + 17, f"{value:.1f}", f"middle on-{class_}")


def _box(svg: Svg, at: tuple[float, float, float, float], class_: str, tip: str) -> None:
    x, y, width, height = at
    svg.add("rect", tip=tip, x=x, y=y, width=width, height=height, class_=f"part {class_}")


def _parts(row: BarRow, words: Mapping[str, str], unit: str) -> str:
    parts = (f"{words[name]} {value:.1f} {unit}" for name, value in row.values.items() if value)
    return ", ".join(parts) or "nothing"


@dataclass(frozen=True, slots=True)
class Column:
    """What was counted from `begin` until `end`, by class."""

    begin: float
    end: float
    counts: Mapping[str, int]


def stacked_columns(
    title: str, columns: Sequence[Column], words: Mapping[str, str], unit: str, about: str
) -> Chart:
    """A column for each part of the axis, which is in `unit`."""
    most = max((sum(each.counts.values()) for each in columns), default=0) or 1
    step = max(1, round(round_step(most / 4)))
    first = columns[0].begin if columns else 0.0
    axis = Axis(44.0, WIDTH_PX - 20, first, columns[-1].end if columns else 1.0)
    svg, bottom = Svg(), 14.0 + _COLUMNS_PX
    per_one = (_COLUMNS_PX - 4) / (-(-most // step) * step)
    for count in range(0, most + step, step):
        y = bottom - per_one * count
        svg.add("line", x1=axis.left_px, x2=axis.right_px, y1=y, y2=y, class_="grid")
        svg.text(axis.left_px - 8, y + 4, str(count), "soft end")
    for each in columns:
        y, x = bottom, axis.x(each.begin)
        width = max(1.0, axis.x(each.end) - x - 3)
        for class_, count in each.counts.items():
            height = per_one * count
            y -= height
            tip = f"{each.begin:g} to {each.end:g} {unit}: {count} {words[class_]}"
            if count:
                _box(svg, (x + 1.5, y, width, height), class_, tip)
    for value in round_ticks(axis.first, axis.last, 10):
        svg.text(axis.x(value), bottom + 16, f"{value:g} {unit}", "soft middle")
    totals = {name: sum(each.counts.get(name, 0) for each in columns) for name in words}
    said = ", ".join(f"{count} {words[name]}" for name, count in totals.items())
    return Chart(
        svg.figure(WIDTH_PX, bottom + 24, title, f"{about}. In all {said}."),
        list(words.items()),
    )


@dataclass(frozen=True, slots=True)
class DotRow:
    """Values of one kind by class, and the middle one of each."""

    label: str
    values: Mapping[str, Sequence[tuple[float, str]]]
    """By class: each value, and whose it is."""
    middles: Mapping[str, float]


def dots(
    title: str, rows: Sequence[DotRow], words: Mapping[str, str], unit: str, about: str
) -> Chart:
    """A line of dots for each class of each row, with a stroke at the middle one."""
    values = [value for row in rows for line in row.values.values() for value, _ in line]
    axis = axis_for([row.label for row in rows], 0.0, max(values, default=0.0) or 1.0)
    svg, bottom = Svg(), _TOP_PX + _ROW_PX * len(rows)
    axis.draw(svg, bottom, unit)
    said = []
    for number, row in enumerate(rows):
        y = _TOP_PX + _ROW_PX * number
        svg.text(0, y + 23, row.label, "name")
        for line, (class_, points) in enumerate(row.values.items()):
            at = y + 12 + 17 * line
            for value, whose in points:
                tip = f"{whose}: {words[class_]} {value:.1f} {unit}"
                svg.add("circle", tip=tip, cx=axis.x(value), cy=at, r=5.0, class_=class_)
            if class_ in row.middles:
                x = axis.x(row.middles[class_])
                svg.add("line", x1=x, x2=x, y1=at - 8, y2=at + 8, class_="median")
                said.append(f"{row.label} {words[class_]} {row.middles[class_]:.1f} {unit}")
    return Chart(
        svg.figure(WIDTH_PX, bottom + 4, title, f"{about}. Medians: {'; '.join(said) or 'none'}."),
        [*words.items(), ("median", "the median")],
    )
