"""What became of what people of a building asked, and how long that took."""

from collections.abc import Callable, Sequence
from statistics import median

from mend.fleet.requests import STATUS, RequestStatus
from mend.server.report.fleet_history import FleetHistory, RequestRecord
from mend.server.report.leg_times import whole_metres_of
from mend.server.report.table import Cell, Table

OUTCOMES = ("done", "not done", "open")
"""What has become of a request."""


def outcome_of(request: RequestRecord) -> str:
    """One of `OUTCOMES`."""
    if not STATUS.is_last(request.status):
        return "open"
    return "done" if request.status is RequestStatus.DONE else "not done"


def requests_by_kind(history: FleetHistory) -> Table:
    """How many there were of each kind, on one floor or several, and what became of them."""
    rows: list[tuple[Cell, ...]] = []
    for kind in sorted({each.kind for each in history.asked}):
        mine = [each for each in history.asked if each.kind == kind]
        floors = [len(_floors(each)) for each in mine]
        outcomes = [outcome_of(each) for each in mine]
        rows.append(
            (
                kind.replace("_", " "),
                len(mine),
                sum(each == 1 for each in floors),
                sum(each > 1 for each in floors),
                *(outcomes.count(each) for each in OUTCOMES),
            )
        )
    note = (
        "Requests that were made in this time, as they stood at its end. Floors are those where "
        "legs began and led to; a request without a leg is on none."
    )
    heads = ("kind", "asked", "one floor", "several floors", *OUTCOMES)
    return Table("requests", "Requests", note, heads, rows)


def waits_by_kind(history: FleetHistory) -> Table:
    """How long people of each kind of request waited."""
    rows = []
    for kind in sorted({each.kind for each in history.asked}):
        mine = [each for each in history.asked if each.kind == kind]
        begins = [each for each in (begun_after_s(e) for e in mine) if each is not None]
        ends = [each for each in map(done_after_s, mine) if each is not None]
        rows.append(
            (
                kind.replace("_", " "),
                len(begins),
                _minutes(begins, median),
                _minutes(begins, max),
                len(ends),
                _minutes(ends, median),
                _minutes(ends, max),
            )
        )
    note = (
        "From when a request was wanted: when it was made, or when it might begin at the "
        "earliest. Set out is when its first robot did."
    )
    heads = (
        "kind",
        "set out for",
        "median, min",
        "longest, min",
        "done",
        "median until done, min",
        "longest until done, min",
    )
    return Table("waits", "Waiting", note, heads, rows)


def each_request(history: FleetHistory) -> Table:
    """Every request, as it was met."""
    rows = []
    for request in history.asked:
        legs = request.legs
        rows.append(
            (
                request.asked.request,
                request.kind.replace("_", " "),
                ", ".join(sorted(_floors(request))),
                request.status.replace("_", " "),
                request.asked.at_s,
                request.wanted_s,
                legs[0].begun.at_s if legs else None,
                request.over_s,
                ", ".join(dict.fromkeys(each.begun.robot for each in legs)),
                whole_metres_of(legs),
                request.now.reason or "",
            )
        )
    heads = (
        "request",
        "kind",
        "floors",
        "status",
        "asked at, s",
        "wanted from, s",
        "set out at, s",
        "over at, s",
        "robots",
        "driven, m",
        "why",
    )
    note = (
        "Seconds of the site's clock. Metres are of the legs that ended in this time; there are "
        "none where it is not known of each of them how far its robot drove."
    )
    return Table("each_request", "Each request", note, heads, rows, folded=True)


def begun_after_s(request: RequestRecord) -> float | None:
    """How long it was wanted when its first robot set out; None where none has."""
    legs = request.legs
    return max(0.0, legs[0].begun.at_s - request.wanted_s) if legs else None


def done_after_s(request: RequestRecord) -> float | None:
    """How long it was wanted when it was done; None where it was not."""
    if request.over_s is None or request.status is not RequestStatus.DONE:
        return None
    return max(0.0, request.over_s - request.wanted_s)


def _floors(request: RequestRecord) -> set[str]:
    return {floor for leg in request.legs for floor in leg.floors}


def _minutes(seconds: Sequence[float], of: Callable[[Sequence[float]], float]) -> float | None:
    return of(seconds) / 60 if seconds else None
