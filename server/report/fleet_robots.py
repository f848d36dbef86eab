"""What each robot of a fleet did, how far it drove, and how often people had to help it."""

from collections.abc import Iterable, Iterator, Sequence
from statistics import median

from mend.server.journal import events as ev
from mend.server.report.fleet_history import FleetHistory, LegRecord
from mend.server.report.leg_times import metres_of
from mend.server.report.table import Cell, Table

_SERVICE = (
    "door_closed",
    "elevator_help",
    "item_not_given",
    "item_not_taken",
    "nobody_answers",
)
"""What people are asked for because a robot has no hands, not because it is in trouble."""


def legs_by_robot(history: FleetHistory) -> Table:
    """How many legs each robot did, and how busy it was."""
    lasts_s = history.ends_s - history.begins_s
    rows = []
    for robot in robots_of(history):
        mine = [each for each in history.legs if each.begun.robot == robot]
        ended = [each.ended for each in mine if each.ended is not None]
        busy_s = sum(_within_s(history, each) for each in mine)
        rows.append(
            (
                robot,
                len(ended),
                sum(each.outcome == "done" for each in ended),
                busy_s / 60,
                100 * busy_s / lasts_s if lasts_s else None,
            )
        )
    note = (
        f"Of {lasts_s / 60:.1f} min of the site's clock. Busy is from a leg's begin to its end, "
        "waiting at its place too."
    )
    heads = ("robot", "legs ended", "legs done", "busy, min", "busy, %")
    return Table("robots", "Robots", note, heads, rows)


def metres_by_robot(history: FleetHistory) -> Table:
    """How far each robot drove, and how far from one intervention of people to the next."""
    robots = robots_of(history)
    rows = [(name, *_metres(history, [name])) for name in robots]
    if len(robots) > 1:
        rows.append(("all", *_metres(history, robots)))
    note = (
        "By the wheels of the robots, in the legs that ended in this time; of some it may not be "
        "known how far they drove, as in journals of an older Mend, and their interventions are "
        "not counted either. An intervention is a dialogue in which a person helped. Part of the "
        "service are doors, elevators, and what is put in, taken out or told."
    )
    heads = (
        "robot",
        "driven, m",
        "legs of which that is known",
        "legs",
        "interventions",
        "m between them",
        "not part of the service",
        "m between those",
    )
    return Table("metres", "Metres and interventions", note, heads, rows)


def _metres(history: FleetHistory, robots: Iterable[str]) -> Iterator[Cell]:
    names = set(robots)
    legs = [leg for leg, _ in history.ended if leg.begun.robot in names]
    known = [each for each in legs if metres_of([each]) is not None]
    helped = interventions_in(known)
    yield from (metres_of(known), len(known), len(legs))
    for issues in (helped, [each for each in helped if each not in _SERVICE]):
        yield len(issues)
        yield metres_between(known, issues)


def interventions_in(legs: Sequence[LegRecord]) -> list[str]:
    """The issues of those legs with which people helped and of which the metres are known."""
    known = (each for each in legs if metres_of([each]) is not None)
    return [issue for leg in known for issue in _helped_with(leg)]


def metres_between(legs: Sequence[LegRecord], interventions: Sequence[str]) -> float | None:
    """How far robots drove from one to the next; None where there is none, or nothing is known."""
    driven_m = metres_of(legs)
    return driven_m / len(interventions) if driven_m is not None and interventions else None


def _helped_with(leg: LegRecord) -> Iterator[str]:
    """The issues of a leg with which people helped, whenever in it."""
    for events in leg.runs.values():
        yield from (each.issue for each in events if isinstance(each, ev.Resolved) and each.helped)


def questions_by_issue(history: FleetHistory) -> Table:
    """What robots asked people, and what came of it."""
    rows = []
    for issue in sorted({each.opened.issue for each in history.dialogues.values()}):
        mine = [each for each in history.dialogues.values() if each.opened.issue == issue]
        took_s = [each.resolved.time - each.opened.time for each in mine if each.resolved]
        rows.append(
            (
                issue.replace("_", " "),
                len(mine),
                sum(each.escalated for each in mine),
                len(took_s),
                sum(each.helped for each in mine),
                median(took_s) if took_s else None,
            )
        )
    heads = ("issue", "dialogues", "escalated", "resolved", "a person helped", "median, s")
    note = (
        "All dialogues of the site's runs that began in this time. The median is from a dialogue's "
        "begin until it was resolved, by the run's clock."
    )
    return Table("questions", "Questions and help", note, heads, rows)


def robots_of(history: FleetHistory) -> list[str]:
    """The robots that had legs."""
    return sorted({each.begun.robot for each in history.legs})


def _within_s(history: FleetHistory, leg: LegRecord) -> float:
    """How long a leg went on in the span."""
    end_s = history.ends_s if leg.ended is None else leg.ended.at_s
    return max(0.0, end_s - max(leg.begun.at_s, history.begins_s))
