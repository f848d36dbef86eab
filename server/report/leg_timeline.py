"""The timeline of a fleet: a row per robot, its legs on it, with what failed and was found."""

from dataclasses import replace

from mend.maps.svg import Svg
from mend.server.journal import events as ev
from mend.server.report.charts import WIDTH_PX, Axis, Chart, TimeUnit, axis_for
from mend.server.report.fleet_history import FleetHistory, LegRecord
from mend.server.report.leg_times import Stretch, TimeUse, stretches_of
from mend.server.report.time_colors import WORDS, class_of

_TOP_PX = 30.0
_ROW_PX = 46.0
_BAR_PX = 18.0
_MOST_PX = 4000.0
_PX_PER_S = 0.8
_NAME_PX = 6.2
_NARROW_PX = 3.0
_PLANS = "plan"


def timeline_of(history: FleetHistory, robots: list[str]) -> Chart:
    """Every leg of these robots, by the site's clock."""
    lasts_s = history.ends_s - history.begins_s
    width = min(max(WIDTH_PX, lasts_s * _PX_PER_S), _MOST_PX)
    labels = [_PLANS, *robots]
    unit = TimeUnit.of(lasts_s)
    axis = axis_for(labels, history.begins_s, history.ends_s, width)
    axis = replace(axis, per_tick=unit.seconds)
    svg, bottom = Svg(), _TOP_PX + _ROW_PX * len(robots) + 34
    axis.draw(svg, bottom, unit.word, ticks=round(width / 110))
    _draw_plans(svg, history, axis)
    seen = set[TimeUse]()
    for number, robot in enumerate(robots):
        y = _TOP_PX + 34 + _ROW_PX * number
        svg.text(0, y + 26, robot, "name")
        free_px = 0.0
        for leg in (each for each in history.legs if each.begun.robot == robot):
            seen |= _draw_leg(svg, history, leg, axis, y + 13)
            free_px = _draw_name(svg, leg, axis, y + 9, free_px)
        for told in history.told:
            if robot in (told.finder, told.robot):
                _draw_told(svg, told, axis, y + 22)
    failed = sum(ended.outcome != "done" for _, ended in history.ended)
    found = sum(each.finder is not None for each in history.told)
    said = (
        f"{_counted(len(history.legs), 'leg')} of {_counted(len(robots), 'robot')} in "
        f"{lasts_s / 60:.1f} min, of which "
        f"{failed} ended without being done; {_counted(found, 'finding')} of robots; "
        f"{_counted(len(history.plans), 'plan change')}. The table below has each leg."
    )
    marks = [("plan", "change of the plan"), ("failed", "leg that ended without being done")]
    marks += [("found", "finding of a robot"), ("out", "out of service, or back")]
    legend = [(class_of(use), words) for use, words in WORDS.items() if use in seen]
    return Chart(svg.figure(width, bottom + 4, "Legs", said), [*legend, *marks])


def _draw_plans(svg: Svg, history: FleetHistory, axis: Axis) -> None:
    y = _TOP_PX + 8
    svg.text(0, y + 12, _PLANS, "name")
    for each in history.plans:
        x = axis.x(each.at_s)
        tip = f"{each.at_s:.1f} s, plan {each.number}: {each.reason}"
        svg.add("rect", tip=tip, x=x - 1.5, y=y, width=3, height=16, class_="plan")


def _draw_leg(
    svg: Svg, history: FleetHistory, leg: LegRecord, axis: Axis, y: float
) -> set[TimeUse]:
    begun, ended = leg.begun, leg.ended
    what = f"{begun.action.replace('_', ' ')} '{begun.booking}' at {begun.place}"
    parts = _drawn_parts(history, leg, axis)
    for each in parts:
        tip = f"{what}: {each.use}, {each.begin_s:.1f} to {each.end_s:.1f} s"
        x, width = axis.x(each.begin_s), axis.x(each.end_s) - axis.x(each.begin_s)
        class_ = f"part {class_of(each.use)}"
        svg.add("rect", tip=tip, x=x, y=y, width=max(width, 0.5), height=_BAR_PX, class_=class_)
    x = axis.x(max(begun.at_s, history.begins_s))
    svg.add("line", x1=x, x2=x, y1=y - 3, y2=y + _BAR_PX + 3, class_="begun")
    if ended is not None and ended.outcome != "done":
        at, middle = axis.x(ended.at_s), y + _BAR_PX / 2
        tip = f"{what}: {ended.outcome.replace('_', ' ')}, {ended.reason or 'no reason given'}"
        cross = f"M{at - 5:.1f} {middle - 5:.1f}l10 10m0-10l-10 10"
        svg.add("path", tip=tip, d=cross, class_="failed")
    return {each.use for each in parts}


def _drawn_parts(history: FleetHistory, leg: LegRecord, axis: Axis) -> list[Stretch]:
    """What there is of a leg in the span; where it is narrow only the longest of it, for all."""
    parts = [
        replace(each, begin_s=max(each.begin_s, history.begins_s))
        for each in stretches_of(leg, history.ends_s)
        if each.end_s > history.begins_s
    ]
    if not parts or axis.x(parts[-1].end_s) - axis.x(parts[0].begin_s) > _NARROW_PX:
        return parts
    longest = max(parts, key=lambda each: each.end_s - each.begin_s)
    return [replace(longest, begin_s=parts[0].begin_s, end_s=parts[-1].end_s)]


def _draw_name(svg: Svg, leg: LegRecord, axis: Axis, y: float, free_px: float) -> float:
    """Name the request of a leg where there is room; returns from where on there is more."""
    x = max(axis.x(leg.begun.at_s), axis.left_px)
    if x < free_px:
        return free_px
    name = f"{leg.begun.booking}: {leg.begun.action.replace('_', ' ')}"
    end_s = axis.last if leg.ended is None else leg.ended.at_s
    room = axis.x(end_s) - x
    if len(name) * _NAME_PX > room:
        name = leg.begun.booking
    if len(name) * _NAME_PX > max(room, 40.0):
        return free_px
    svg.text(x, y, name, "soft")
    return x + len(name) * _NAME_PX + 6


def _draw_told(svg: Svg, told: ev.FleetTold, axis: Axis, y: float) -> None:
    tip, x = f"{told.at_s:.1f} s: {told.told}", axis.x(told.at_s)
    if told.finder is not None:
        path = f"M{x:.1f} {y - 7:.1f}l7 7-7 7-7-7z"
        svg.add("path", tip=tip, d=path, class_="found")
    else:
        path = f"M{x - 6:.1f} {y + 6:.1f}h12l-6-12z"
        svg.add("path", tip=tip, d=path, class_="out")


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"
