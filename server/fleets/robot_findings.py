"""What robots find of the ways that they drive, as far as other ways lead where they are to go."""

import logging
from collections.abc import AsyncIterator, Collection

from mend.fleet.dispatch.leg import Finding, Found
from mend.maps.navigation import NavigationGraph
from mend.server.journal import events as ev
from mend.server.journal.journal import Journal
from mend.server.journal.subscriptions import PrunedEventsError, SubscriptionOverflowError

log = logging.getLogger(__name__)

FindingEvent = ev.IssueRaised | ev.WayFound

_TYPES = ('"issue_raised"', '"way_found"')


def finding_of(event: FindingEvent) -> Found | None:
    """What a robot has found of a way; None for what says nothing of one.

    What it asks people about is called as the issue is.
    """
    if isinstance(event, ev.WayFound):
        finding, between = event.finding, event.between
    else:
        finding = event.issue
        between = [] if event.detection is None else event.detection.between
    if finding not in list(Finding) or len(between) != 2:
        return None
    return Found(finding=Finding(finding), between=(between[0], between[1]), by=event.robot)


def is_led_round(
    graph: NavigationGraph, closed: Collection[frozenset[str]], found: Found, place: str
) -> bool:
    """Whether another way leads from before what was found to a place.

    Where none does, people are to help, and the plan stays: nobody else would get there either.
    """
    shut = {*closed, *graph.together(found.between)}
    open_ = [e for e in graph.ways if not e.closed and frozenset((e.a, e.b)) not in shut]
    reached, new = set[str](), {found.between[0]}
    while new:
        reached |= new
        beyond = {e.b for e in open_ if e.a in new}
        beyond |= {e.a for e in open_ if e.b in new and not e.one_way}
        new = beyond - reached
    return place in reached


async def findings(journal: Journal) -> AsyncIterator[FindingEvent]:
    """What robots find in all runs from now on, until the journal is closed."""
    while True:
        with journal.subscribe(journal.head) as news:
            try:
                async for record in news:
                    if not any(each in record.text for each in _TYPES):
                        continue
                    event = ev.any_event.validate_json(record.text)
                    if isinstance(event, FindingEvent):
                        yield event
                return
            except (SubscriptionOverflowError, PrunedEventsError) as error:
                # What robots found meanwhile they find again.
                log.warning("a fleet did not hear all that robots found: %s", error)
