"""Why the plans of a fleet changed, and what changed robots on its way."""

from mend.fleet.requests import LegAction
from mend.server.journal import events as ev
from mend.server.report.fleet_history import FleetHistory, LegRecord, RequestRecord
from mend.server.report.table import Cell, Table


def plan_changes(history: FleetHistory) -> Table:
    """Each change of the plan."""
    rows = [
        (each.at_s, each.number, each.reason, ", ".join(each.requests), ", ".join(each.robots))
        for each in history.plans
    ]
    heads = ("at, s", "number", "why", "requests", "robots")
    note = "Each change of the plan, by the site's clock."
    return Table("plans", "Why plans changed", note, heads, rows, folded=True)


def transfers(history: FleetHistory) -> Table:
    """What one robot left for another, where, how long it lay there, and what that was to save."""
    rows: list[tuple[Cell, ...]] = []
    for leg, ended in _given(history):
        take = _taken(leg, ended.at_s)
        # However often it changes robots, it is compared with one robot once.
        plan = leg.request.transfer if leg.request and leg is _first_given(leg.request) else None
        rows.append(
            (
                leg.begun.booking,
                leg.begun.place,
                leg.begun.robot,
                ended.at_s,
                None if take is None else take.robot,
                None if take is None else take.at_s,
                None if take is None else take.at_s - ended.at_s,
                None if plan is None else plan.sooner_s,
                None if plan is None else plan.less_m,
            )
        )
    return Table("transfers", "Transfers", _saved(history), _TRANSFER_HEADS, rows)


_TRANSFER_HEADS = (
    "request",
    "at",
    "left by",
    "left at, s",
    "taken by",
    "taken at, s",
    "lay there, s",
    "sooner as planned, s",
    "less driven as planned, m",
)


def saved_s(history: FleetHistory) -> list[float]:
    """How much sooner what changed robots in the span was to be delivered, as far as is known."""
    plans = (
        leg.request.transfer
        for leg, _ in _given(history)
        if leg.request is not None and leg is _first_given(leg.request)
    )
    return [each.sooner_s for each in plans if each is not None and each.sooner_s is not None]


def _given(history: FleetHistory) -> list[tuple[LegRecord, ev.LegEnded]]:
    """The legs in which robots left something for another."""
    return [(leg, ended) for leg, ended in history.ended if _is_given(leg)]


def _first_given(request: RequestRecord) -> LegRecord:
    return next(each for each in request.legs if _is_given(each))


def _is_given(leg: LegRecord) -> bool:
    gives = leg.begun.action == LegAction.GIVE
    return gives and leg.ended is not None and leg.ended.outcome == "done"


def _saved(history: FleetHistory) -> str:
    """What the figures were counted over, and what they add up to."""
    sooner_s = saved_s(history)
    note = (
        "What changed robots in this time, by the site's clock. Sooner is how much, by the plan "
        "that was made, one robot alone would have delivered it later; of what is not known, or "
        "where one alone could not have brought it, there is none."
    )
    if not sooner_s:
        return note
    noun = "request" if len(sooner_s) == 1 else "requests"
    saved_min = sum(sooner_s) / 60
    return f"{saved_min:.1f} min were to be saved in all, with {len(sooner_s)} {noun}. {note}"


def _taken(given: LegRecord, since_s: float) -> ev.LegEnded | None:
    """How the leg ended in which another robot took what was left."""
    ends = [each.ended for each in given.request.legs] if given.request else []
    return next(
        (
            ended
            for ended in ends
            if ended is not None
            and ended.action in (LegAction.TAKE, LegAction.COLLECT)
            and ended.outcome == "done"
            and ended.at_s >= since_s
            and ended.robot != given.begun.robot
        ),
        None,
    )
