"""How the time of a fleet's legs was spent, by kind of request and by robot."""

from collections.abc import Callable, Sequence

from mend.server.report.fleet_history import FleetHistory, LegRecord
from mend.server.report.leg_times import TimeUse, stretches_of, time_split
from mend.server.report.table import Table

_NOTE = (
    "Minutes of the legs that ended in this time, each second in one class. Asking for help counts "
    "as what it was asked for. Blocked is also what a robot met and let pass without asking, where "
    "it has said so. Staying or waiting is at the place of a leg, until it is time, and before it "
    "sets out, while another robot has that place. Other is looking round between steps, and "
    "without a connection. Journals of an older Mend do not say what the steps of a robot were "
    "for: that time is not journaled."
)


def times_by_kind(history: FleetHistory) -> Table:
    """Minutes by class, for the legs of each kind of request."""
    return _times(history, ("times", "How the time was spent", _NOTE), "kind", _kind)


def times_by_robot(history: FleetHistory) -> Table:
    """Minutes by class, for the legs of each robot."""
    about = ("times_by_robot", "The same by robot", "As above.")
    return _times(history, about, "robot", lambda leg: leg.begun.robot)


def split_of(legs: Sequence[LegRecord]) -> dict[TimeUse, float]:
    """Seconds by class of all these legs, which have ended."""
    splits = [time_split(each) for each in legs]
    return {use: sum(each[use] for each in splits) for use in TimeUse}


def legs_by(history: FleetHistory, group: Callable[[LegRecord], str]) -> dict[str, list[LegRecord]]:
    """The legs that ended in the span, by what they have in common."""
    groups: dict[str, list[LegRecord]] = {}
    for leg, _ in history.ended:
        groups.setdefault(group(leg), []).append(leg)
    return dict(sorted(groups.items()))


def _times(
    history: FleetHistory,
    about: tuple[str, str, str],
    head: str,
    group: Callable[[LegRecord], str],
) -> Table:
    groups = legs_by(history, group)
    rows = [_row(label, legs) for label, legs in groups.items()]
    if len(groups) > 1:
        rows.append(_row("all", [each for legs in groups.values() for each in legs]))
    heads = (head, "requests", "legs", *(f"{use}, min" for use in TimeUse), "all, min")
    return Table(*about, heads, rows)


def _row(label: str, legs: Sequence[LegRecord]) -> tuple[str | int | float, ...]:
    split = split_of(legs)
    requests = len({each.begun.booking for each in legs})
    minutes = [seconds / 60 for seconds in split.values()]
    return (label, requests, len(legs), *minutes, sum(minutes))


def each_leg(history: FleetHistory) -> Table:
    """Every leg that ended in the span, with its seconds by class."""
    rows = []
    for leg, ended in history.ended:
        begun = leg.begun
        split = time_split(leg)
        rows.append(
            (
                begun.robot,
                begun.number,
                begun.booking,
                _kind(leg),
                begun.action.replace("_", " "),
                begun.start,
                begun.place,
                begun.at_s,
                ended.at_s,
                ended.outcome.replace("_", " "),
                ended.driven_m,
                *split.values(),
                ended.reason or "",
            )
        )
    heads = (
        "robot",
        "number",
        "request",
        "kind",
        "action",
        "from",
        "to",
        "begun at, s",
        "ended at, s",
        "outcome",
        "driven, m",
        *(f"{use}, s" for use in TimeUse),
        "why",
    )
    note = "Seconds of the site's clock."
    return Table("legs", "Timeline of legs", note, heads, rows, folded=True)


def each_stretch(history: FleetHistory) -> Table:
    """What the timeline is drawn from."""
    rows = [
        (
            leg.begun.robot,
            leg.begun.number,
            leg.begun.booking,
            str(part.use),
            part.begin_s,
            part.end_s,
        )
        for leg in history.legs
        for part in stretches_of(leg, history.ends_s)
    ]
    heads = ("robot", "number", "request", "what", "from, s", "until, s")
    note = "Seconds of the site's clock; of standing before something only what was asked about."
    return Table("stretches", "How each leg's time was spent", note, heads, rows, folded=True)


def _kind(leg: LegRecord) -> str:
    return leg.kind.replace("_", " ")
