"""The timeline: what happened to each leaf along the run's clock, laid out for a drawing."""

import math
from dataclasses import dataclass, field

from mend.server.report.record import Attempt, Fault, RunRecord
from mend.server.transcript_words import deed_text

LABELS_PX = 150
MARGIN_PX = 16
PLOT_MIN_PX = 840
PLOT_MAX_PX = 4000
PX_PER_SECOND = 2.2
AXIS_PX = 26
BAR_PX = 16
CAPTION_PX = 15
ROW_GAP_PX = 14
CHARACTER_PX = 6.6
TICKS_S = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1800, 3600, 7200, 21600, 86400)
TICK_MIN_PX = 70


@dataclass(frozen=True, slots=True)
class Tick:
    x: float
    text: str


@dataclass(frozen=True, slots=True)
class Bar:
    """A stretch of time in a row. `kind`: step, wait, dialogue; `tip` is shown on hover."""

    x: float
    width: float
    kind: str
    tip: str


@dataclass(frozen=True, slots=True)
class Mark:
    """A moment in a row. `kind`: fault, deed, done, put back, left out, undone, cut off."""

    x: float
    kind: str
    tip: str


@dataclass(frozen=True, slots=True)
class Caption:
    """Words above a bar, `level` lines up; `end` anchors them by their end."""

    x: float
    text: str
    level: int
    end: bool


@dataclass(slots=True)
class Row:
    """One leaf (or the people), `top` px down; its bar begins at `bar_top`."""

    label: str
    object: str | None
    top: float = 0.0
    bars: list[Bar] = field(default_factory=list)
    marks: list[Mark] = field(default_factory=list)
    captions: list[Caption] = field(default_factory=list)

    @property
    def bar_top(self) -> float:
        levels = max((each.level for each in self.captions), default=-1) + 1
        return self.top + levels * CAPTION_PX

    @property
    def bottom(self) -> float:
        return self.bar_top + BAR_PX


@dataclass(frozen=True, slots=True)
class Timeline:
    """Everything of the drawing, in px of its own coordinates."""

    width: float
    height: float
    plot_left: float
    plot_right: float
    rows: list[Row]
    ticks: list[Tick]


class _Scale:
    """From seconds of the run's clock to px."""

    def __init__(self, end_s: float) -> None:
        self.end_s = max(end_s, 1.0)
        self.plot_px = min(max(self.end_s * PX_PER_SECOND, PLOT_MIN_PX), PLOT_MAX_PX)

    def x(self, time_s: float) -> float:
        return round(LABELS_PX + time_s / self.end_s * self.plot_px, 1)

    def ticks(self) -> list[Tick]:
        px_per_s = self.plot_px / self.end_s
        every_s = next((each for each in TICKS_S if each * px_per_s >= TICK_MIN_PX), TICKS_S[-1])
        return [
            Tick(self.x(i * every_s), f"{i * every_s} s")
            for i in range(math.floor(self.end_s / every_s) + 1)
        ]


def lay_out_timeline(record: RunRecord) -> Timeline:
    """A row for the people if they did anything, then one per leaf in the order of their starts."""
    scale = _Scale(record.end_s)
    rows = [_people(record, scale)] if record.interventions else []
    rows += _leaves(record, scale)
    y = float(AXIS_PX)
    for row in rows:
        row.top = y
        y = row.bottom + ROW_GAP_PX
    return Timeline(
        width=LABELS_PX + scale.plot_px + MARGIN_PX,
        height=y,
        plot_left=LABELS_PX,
        plot_right=LABELS_PX + scale.plot_px,
        rows=rows,
        ticks=scale.ticks(),
    )


def _people(record: RunRecord, scale: _Scale) -> Row:
    row = Row("people", None)
    for each in record.interventions:
        tip = f"{each.time:.1f} s: person ({each.by}) {deed_text(each.intervention)}"
        row.marks.append(Mark(scale.x(each.time), "deed" if each.ok else "vain deed", tip))
        _add_caption(row, scale, each.time, each.act.replace("_", " "))
    return row


def _leaves(record: RunRecord, scale: _Scale) -> list[Row]:
    rows: dict[str, Row] = {}
    objects = {each.raised.node: each.raised.object for each in record.faults}
    for execution in record.executions:
        node, name = execution.started.node, execution.started.name
        row = rows.setdefault(node, Row(name, objects.get(node, name)))
        _add_execution(row, execution, scale, record.end_s)
    for fault in record.faults:
        if fault.raised.node in rows:
            _add_fault(rows[fault.raised.node], fault, scale, record.end_s)
    for undone in record.undone:
        if undone.node in rows:
            tip = f"{undone.time:.1f} s: done no longer, {undone.reason}"
            rows[undone.node].marks.append(Mark(scale.x(undone.time), "undone", tip))
    return list(rows.values())


def _add_execution(row: Row, execution: Attempt, scale: _Scale, run_end_s: float) -> None:
    started = execution.started
    end_s = run_end_s if execution.end_s is None else execution.end_s
    tip = f"{started.name}, attempt {started.attempt}: {started.time:.1f} to {end_s:.1f} s"
    row.bars.append(_bar(scale, started.time, end_s, "wait", tip))
    for step in execution.steps:
        step_end_s = end_s if step.end_s is None else step.end_s
        tip = (
            f"{step.number} {step.name.replace('_', ' ')}: {step.start_s:.1f} to {step_end_s:.1f} s"
        )
        row.bars.append(_bar(scale, step.start_s, step_end_s, "step", tip))
    row.marks.append(Mark(scale.x(end_s), execution.ending, f"{end_s:.1f} s: {execution.ending}"))


def _add_fault(row: Row, fault: Fault, scale: _Scale, run_end_s: float) -> None:
    raised = fault.raised
    end_s = run_end_s if fault.end_s is None else fault.end_s
    if end_s > raised.time:
        tip = f"dialogue about {raised.issue}: {raised.time:.1f} to {end_s:.1f} s, {fault.outcome}"
        row.bars.append(_bar(scale, raised.time, end_s, "dialogue", tip))
    tip = f"{raised.time:.1f} s: {raised.issue}, {fault.outcome}"
    row.marks.append(Mark(scale.x(raised.time), "fault", tip))
    _add_caption(row, scale, raised.time, f"{raised.issue} → {fault.outcome}")


def _bar(scale: _Scale, start_s: float, end_s: float, kind: str, tip: str) -> Bar:
    x = scale.x(start_s)
    return Bar(x, max(round(scale.x(end_s) - x, 1), 0.5), kind, tip)


def _add_caption(row: Row, scale: _Scale, time_s: float, text: str) -> None:
    """Put words above a moment, on the lowest line where they cover no others."""
    x, width = scale.x(time_s), len(text) * CHARACTER_PX
    end = x + width > LABELS_PX + scale.plot_px + MARGIN_PX
    left = x - width if end else x
    level = 0
    while any(
        each.level == level
        and left < _left(each) + len(each.text) * CHARACTER_PX + CHARACTER_PX
        and left + width + CHARACTER_PX > _left(each)
        for each in row.captions
    ):
        level += 1
    row.captions.append(Caption(x, text, level, end))


def _left(caption: Caption) -> float:
    return caption.x - len(caption.text) * CHARACTER_PX if caption.end else caption.x
