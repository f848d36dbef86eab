"""Why the plans of a fleet changed, and what changed robots on its way."""

from mend.fleet.requests import LegAction
from mend.server.journal import events as ev
from mend.server.report.fleet_history import FleetHistory, LegRecord
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
    told = set[str]()
    for leg, ended in history.ended:
        if leg.begun.action != LegAction.GIVE or ended.outcome != "done":
            continue
        request, take = leg.begun.booking, _taken(history, leg, ended.at_s)
        plan = None if request in told else history.planned.get(request)
        told.add(request)
        rows.append(
            (
                request,
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
    given = {
        leg.begun.booking
        for leg, ended in history.ended
        if leg.begun.action == LegAction.GIVE and ended.outcome == "done"
    }
    plans = (history.planned[each] for each in given if each in history.planned)
    return [each.sooner_s for each in plans if each.sooner_s is not None]


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


def _taken(history: FleetHistory, given: LegRecord, since_s: float) -> ev.LegEnded | None:
    """The leg in which another robot took what was left."""
    return next(
        (
            ended
            for _, ended in history.ended
            if ended.booking == given.begun.booking
            and ended.action in (LegAction.TAKE, LegAction.COLLECT)
            and ended.outcome == "done"
            and ended.at_s >= since_s
            and ended.robot != given.begun.robot
        ),
        None,
    )
