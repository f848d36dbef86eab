"""What robots find of the ways that they drive, as far as other ways lead where they are to go."""

import logging
from collections.abc import AsyncIterator, Collection

from mend.fleet.dispatch.leg import Finding, Found, Leg
from mend.maps.navigation import NavigationGraph
from mend.server.journal import events as ev
from mend.server.journal.journal import Journal
from mend.server.journal.subscriptions import PrunedEventsError, SubscriptionOverflowError

log = logging.getLogger(__name__)

FINDINGS = {"blocked": Finding.BLOCKED, "door_closed": Finding.DOOR_CLOSED}
"""What an issue says of the way on which it was raised."""


def finding_of(raised: ev.IssueRaised, leg: Leg) -> Found | None:
    """What a robot with a leg has found; None for what says nothing of a way."""
    finding, seen = FINDINGS.get(raised.issue), raised.detection
    if finding is None or seen is None or len(seen.between) != 2:
        return None
    return Found(finding=finding, between=(seen.between[0], seen.between[1]), by=leg.robot)


def is_led_round(
    graph: NavigationGraph, closed: Collection[frozenset[str]], found: Found, place: str
) -> bool:
    """Whether another way leads from before what was found to a place.

    Where none does, people are to help, and the plan stays: nobody else would get there either.
    """
    shut = {*closed, frozenset(found.between)}
    open_ = [e for e in graph.ways if not e.closed and frozenset((e.a, e.b)) not in shut]
    reached, new = set[str](), {found.between[0]}
    while new:
        reached |= new
        beyond = {e.b for e in open_ if e.a in new}
        beyond |= {e.a for e in open_ if e.b in new and not e.one_way}
        new = beyond - reached
    return place in reached


async def issues_raised(journal: Journal) -> AsyncIterator[ev.IssueRaised]:
    """The issues of all runs from now on, until the journal is closed."""
    while True:
        with journal.subscribe(journal.head) as news:
            try:
                async for record in news:
                    if '"issue_raised"' not in record.text:
                        continue
                    event = ev.any_event.validate_json(record.text)
                    if isinstance(event, ev.IssueRaised):
                        yield event
                return
            except (SubscriptionOverflowError, PrunedEventsError) as error:
                # What robots found meanwhile they find again.
                log.warning("a fleet did not hear of all issues: %s", error)
