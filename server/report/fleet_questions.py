"""What robots asked people in the runs of a site, and what came of it."""

from collections.abc import Iterable
from statistics import median
from uuid import UUID

from mend.server.journal import events as ev
from mend.server.report.fleet_tally import Table

TYPES = ("run_started", "dialogue_opened", "escalated", "resolved")
"""The types of the events that questions are counted from."""


def questions_of(site: UUID, events: Iterable[ev.Event]) -> Table:
    """By issue, the dialogues of the site's runs, from events in order."""
    runs: set[UUID] = set()
    opened: dict[UUID, ev.DialogueOpened] = {}
    escalated: set[UUID] = set()
    resolved: dict[UUID, ev.Resolved] = {}
    for event in events:
        match event:
            case ev.RunStarted(site=at) if at == site:
                runs.add(event.run)
            case ev.DialogueOpened() if event.run in runs:
                opened[event.dialogue] = event
            case ev.Escalated():
                escalated.add(event.dialogue)
            case ev.Resolved():
                resolved[event.dialogue] = event
    rows = []
    for issue in sorted({each.issue for each in opened.values()}):
        mine = [each for each in opened.values() if each.issue == issue]
        ended = [(each, resolved[each.dialogue]) for each in mine if each.dialogue in resolved]
        took_s = [end.time - begin.time for begin, end in ended]
        rows.append(
            (
                issue.replace("_", " "),
                str(len(mine)),
                str(sum(each.dialogue in escalated for each in mine)),
                str(len(ended)),
                str(sum(end.helped for _, end in ended)),
                f"{median(took_s):.1f}" if took_s else "-",
            )
        )
    heads = ("issue", "dialogues", "escalated", "resolved", "a person helped", "median, s")
    note = (
        "All dialogues of the site's runs. The median is from a dialogue's begin until it was "
        "resolved, by the run's clock."
    )
    return Table("questions", "Questions and help", note, heads, rows)
