"""Why the plans of a fleet changed, and what changed robots on its way."""

from mend.server.report.fleet_history import FleetHistory
from mend.server.report.table import Table


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
    """What one robot left for another, where, and how long it lay there."""
    rows = []
    for leg, ended in history.ended:
        if leg.begun.action != "give" or ended.outcome != "done":
            continue
        taken = next(
            (
                later
                for later, end in history.ended
                if later.begun.booking == leg.begun.booking
                and later.begun.action == "take"
                and end.outcome == "done"
                and end.at_s >= ended.at_s
            ),
            None,
        )
        rows.append(
            (
                leg.begun.booking,
                leg.begun.place,
                leg.begun.robot,
                ended.at_s,
                None if taken is None else taken.begun.robot,
                None if taken is None or taken.ended is None else taken.ended.at_s,
                None if taken is None or taken.ended is None else taken.ended.at_s - ended.at_s,
            )
        )
    heads = ("request", "at", "left by", "left at, s", "taken by", "taken at, s", "lay there, s")
    note = "What changed robots in this time, by the site's clock."
    return Table("transfers", "Transfers", note, heads, rows)
