"""The charts of a fleet's report, each with the table that tells the same."""

from collections.abc import Mapping
from statistics import median

from mend.server.report.charts import (
    BarRow,
    Chart,
    Column,
    DotRow,
    TimeUnit,
    dots,
    round_step,
    stacked_bars,
    stacked_columns,
)
from mend.server.report.fleet_history import FleetHistory
from mend.server.report.fleet_requests import OUTCOMES, begun_after_s, done_after_s, outcome_of
from mend.server.report.fleet_robots import robots_of
from mend.server.report.fleet_times import legs_by, split_of
from mend.server.report.leg_timeline import timeline_of
from mend.server.report.table import Table
from mend.server.report.time_colors import WORDS, class_of

COLUMNS = 20
"""Requests are counted in about so many parts of the span."""
_WAITS = {"until-begun": "until a robot set out", "until-done": "until it was done"}


def charts_of(history: FleetHistory) -> Mapping[str, Chart]:
    """By the name of the table under them; only of what there is anything to draw."""
    charts = dict[str, Chart]()
    if history.asked:
        charts |= {"requests_by_time": _requests(history), "waits": _waits(history)}
    if history.ended:
        charts |= {"times": _times_by_kind(history), "times_by_robot": _times_by_robot(history)}
    if history.legs:
        charts["legs"] = timeline_of(history, robots_of(history))
    return charts


def requests_by_time(history: FleetHistory) -> Table:
    """What became of the requests that were made when."""
    unit, columns = _columns(history)
    heads = (f"from, {unit}", f"until, {unit}", *OUTCOMES)
    rows = [(each.begin, each.end, *each.counts.values()) for each in columns if history.asked]
    note = "By when they were made, by the site's clock, as they stood at the end."
    return Table("requests_by_time", "Requests over time", note, heads, rows, folded=True)


def _columns(history: FleetHistory) -> tuple[str, list[Column]]:
    """The unit of time, and what was counted in each of its parts."""
    unit = TimeUnit.of(history.ends_s - history.begins_s)
    first, last = history.begins_s / unit.seconds, history.ends_s / unit.seconds
    step = round_step(max(last - first, 1.0) / COLUMNS)
    begins = int(first // step)
    counts = [dict.fromkeys(_OUTCOME_CLASSES, 0) for _ in range(begins, int(last // step) + 1)]
    for each in history.asked:
        number = int(each.asked.at_s / unit.seconds // step) - begins
        counts[number][_class_of_outcome(outcome_of(each))] += 1
    return unit.word, [
        Column(number * step, (number + 1) * step, each)
        for number, each in enumerate(counts, start=begins)
    ]


def _class_of_outcome(outcome: str) -> str:
    return f"outcome-{outcome.replace(' ', '-')}"


_OUTCOME_CLASSES = {_class_of_outcome(each): each for each in OUTCOMES}


def _requests(history: FleetHistory) -> Chart:
    about = "Requests by when they were made, and what became of them"
    unit, columns = _columns(history)
    return stacked_columns("Requests over time", columns, _OUTCOME_CLASSES, unit, about)


def _waits(history: FleetHistory) -> Chart:
    rows = []
    for kind in sorted({each.kind for each in history.asked}):
        mine = [each for each in history.asked if each.kind == kind]
        values: dict[str, list[tuple[float, str]]] = {name: [] for name in _WAITS}
        for each in mine:
            for name, seconds in zip(
                _WAITS, (begun_after_s(each), done_after_s(each)), strict=True
            ):
                if seconds is not None:
                    values[name].append((seconds / 60, each.asked.request))
        middles = {
            name: median(value for value, _ in line) for name, line in values.items() if line
        }
        rows.append(DotRow(kind.replace("_", " "), values, middles))
    about = "How long each request had been wanted"
    return dots("Waiting", rows, _WAITS, "min", about)


def _times_by_kind(history: FleetHistory) -> Chart:
    rows = []
    for kind, legs in legs_by(history, lambda each: each.kind).items():
        requests = len({each.begun.booking for each in legs})
        values = {class_of(use): s / 60 / requests for use, s in split_of(legs).items()}
        noun = "request" if requests == 1 else "requests"
        rows.append(BarRow(kind.replace("_", " "), f"{requests} {noun}", values))
    about = "Minutes of robots per request, on average"
    return stacked_bars("Time by kind of request", rows, _time_words(), "min", about)


def _times_by_robot(history: FleetHistory) -> Chart:
    rows = []
    for robot, legs in legs_by(history, lambda each: each.begun.robot).items():
        values = {class_of(use): seconds / 60 for use, seconds in split_of(legs).items()}
        rows.append(BarRow(robot, f"{len(legs)} leg{'s' if len(legs) > 1 else ''}", values))
    about = "Minutes of each robot's legs, in all"
    return stacked_bars("Time by robot", rows, _time_words(), "min", about)


def _time_words() -> dict[str, str]:
    return {class_of(use): words for use, words in WORDS.items()}
