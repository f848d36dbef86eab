"""The journal of a service under test, as soon as enough is in it."""

import asyncio
from collections.abc import Callable

from mend.server.composition import Service
from mend.server.journal import events as ev
from mend.server.journal.stored_event import read_event


async def events_until(
    service: Service, is_enough: Callable[[list[ev.Event]], bool]
) -> list[ev.Event]:
    """All events so far, once there are enough."""
    events: list[ev.Event] = []
    with service.journal.subscribe(0, 100_000) as records:
        async for record in records:
            events.append(read_event(record.seq, record.text))
            if is_enough(events):
                return events
    raise AssertionError("the journal ended")


async def when(service: Service, so: Callable[[ev.Event], bool]) -> ev.Event:
    """The first event of which something is so, also of those that were."""
    async with asyncio.timeout(60.0):
        events = await events_until(service, lambda each: so(each[-1]))
    return events[-1]
