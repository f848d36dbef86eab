"""What a run showed and told in the order of its clock, whenever the journal was told of it.

A clip or a film is journaled when it has ended, with pictures from before the last events.
"""

from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import dataclass
from heapq import heappop, heappush

from mend.server.export.run_file import ShownPicture, pictures_of
from mend.server.journal import events as ev
from mend.server.journal.subscriptions import Record

AHEAD_S = 120.0
"""So much of the run is read ahead of what is told, for pictures that belong before that."""
AHEAD_EVENTS = 2_000
AHEAD_CHARS = 4 * 1024**2
"""No more than this is held meanwhile; a picture whose event comes later yet follows then."""


@dataclass(frozen=True, slots=True)
class ToldEvent:
    """An event and its JSON."""

    event: ev.Event
    text: str

    @property
    def time_s(self) -> float:
        return self.event.time


class _Held:
    """What is read and not told yet: events in their order, and pictures by their time."""

    def __init__(self) -> None:
        self._events: deque[ToldEvent] = deque()
        self._pictures: list[tuple[float, int, ShownPicture]] = []
        self._chars = 0
        self._shown = 0
        self._began = False

    def add(self, told: ToldEvent) -> None:
        self._events.append(told)
        self._chars += len(told.text)
        for each in pictures_of(told.event):
            heappush(self._pictures, (each.time_s, self._shown, each))
            self._shown += 1

    @property
    def is_full(self) -> bool:
        """Whether its first event has waited for pictures long enough."""
        events = self._events
        return len(events) > 1 and (
            events[-1].time_s - events[0].time_s > AHEAD_S
            or len(events) > AHEAD_EVENTS
            or self._chars > AHEAD_CHARS
        )

    def take(self) -> ToldEvent | ShownPicture | None:
        """What comes first: a picture before an event of the same time; None once it is empty."""
        picture, event = self._pictures[:1], self._events
        if picture and self._began and (not event or picture[0][0] <= event[0].time_s):
            return heappop(self._pictures)[2]
        if not self._events:
            return None
        # A file begins with the run.
        self._began = True
        told = self._events.popleft()
        self._chars -= len(told.text)
        return told


async def in_order(
    records: AsyncIterator[Record], read: Callable[[Record], Awaitable[ev.Event]]
) -> AsyncIterator[ToldEvent | ShownPicture]:
    """The events, and each picture before those that come after it."""
    held = _Held()
    async for record in records:
        held.add(ToldEvent(await read(record), record.text))
        while held.is_full and (each := held.take()) is not None:
            yield each
    while (each := held.take()) is not None:
        yield each
