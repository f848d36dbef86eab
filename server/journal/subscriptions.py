"""Following the journal: every event after a number, in order, none missing, none twice."""

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, Self

from mend.errors import MendError

DEFAULT_CAPACITY = 4096
REPLAY_PAGE = 500


@dataclass(frozen=True, slots=True)
class Record:
    """A committed event as JSON text, serialized once for the database and for every client."""

    seq: int
    text: str


class SubscriptionOverflowError(MendError):
    """The subscriber fell too far behind; it may subscribe again after the last `seq` it saw."""


class PrunedEventsError(MendError):
    """Not every event after the last one seen is in the journal any more."""


class RecordSource(Protocol):
    """Where a subscription finds what was committed before it went live."""

    @property
    def head(self) -> int: ...

    async def read_records(self, after: int, limit: int) -> list[Record]: ...


class Subscribers:
    """Everybody who follows the journal; belongs to one event loop."""

    def __init__(self) -> None:
        self._live: set[Subscription] = set()
        self._overflows = 0
        self._closed = False

    def __len__(self) -> int:
        return len(self._live)

    @property
    def overflows(self) -> int:
        """How many subscribers were cut off because they were too slow."""
        return self._overflows

    def add(self, subscription: "Subscription") -> None:
        self._live.add(subscription)
        if self._closed:
            subscription.close()

    def discard(self, subscription: "Subscription") -> None:
        self._live.discard(subscription)

    def publish(self, records: Sequence[Record]) -> None:
        """Hand committed events to everybody; whoever has no room for them is cut off."""
        for subscription in tuple(self._live):
            if not subscription.offer(records):
                self._overflows += 1
                self._live.discard(subscription)

    def close(self) -> None:
        """End every subscription after what it was already given."""
        self._closed = True
        for subscription in tuple(self._live):
            subscription.close()


class Subscription:
    """One subscriber's bounded queue; iterate over it, or `take` what there is.

    It first reads from the journal at the subscriber's own pace, and goes live when it has caught
    up. Only a live one can overflow.
    """

    def __init__(
        self,
        source: RecordSource,
        subscribers: Subscribers,
        after: int,
        capacity: int = DEFAULT_CAPACITY,
    ) -> None:
        self._source = source
        self._subscribers = subscribers
        self._seen = after
        self._capacity = capacity
        self._queue: deque[Record] = deque()
        self._wake = asyncio.Event()
        self._live = False
        self._overflowed = False
        self._closed = False

    def offer(self, records: Iterable[Record]) -> bool:
        """Queue committed events; False when there is no room, which ends the subscription."""
        for record in records:
            if record.seq <= self._seen:
                continue
            if len(self._queue) >= self._capacity:
                self._overflowed = True
                self._queue.clear()
                self._wake.set()
                return False
            self._queue.append(record)
        self._wake.set()
        return True

    async def take(self) -> list[Record]:
        """Wait for the next events; empty only when the subscription or the journal has closed.

        Raises `SubscriptionOverflowError`, and `PrunedEventsError` rather than leave one out.
        """
        if not self._live:
            replayed = await self._replay()
            if replayed:
                return replayed
        while not self._queue and not self._closed and not self._overflowed:
            self._wake.clear()
            await self._wake.wait()
        if self._overflowed:
            raise SubscriptionOverflowError(
                f"more than {self._capacity} events were waiting; connect again with "
                f"after={self._seen}"
            )
        return self._remember(list(self._drain()))

    async def _replay(self) -> list[Record]:
        """The next page from the journal; empty, and live from then on, when there is no more."""
        if self._seen < self._source.head:
            records = await self._source.read_records(self._seen, REPLAY_PAGE)
            self._refuse_gap(records)
            return self._remember(records)
        # Nothing is awaited between this and the comparison with the head, and the journal moves
        # its head and publishes in one step: nothing can fall in between.
        self._live = True
        if not self._closed:
            self._subscribers.add(self)
        return []

    def _refuse_gap(self, records: Sequence[Record]) -> None:
        """Raises `PrunedEventsError` unless the records follow what was seen without a gap."""
        expected = self._seen + 1
        for record in records:
            if record.seq != expected:
                break
            expected += 1
        else:
            if records:
                return
        raise PrunedEventsError(f"event {expected} was pruned: connect again for the state of now")

    def _drain(self) -> Iterable[Record]:
        while self._queue:
            yield self._queue.popleft()

    def _remember(self, records: list[Record]) -> list[Record]:
        if records:
            self._seen = records[-1].seq
        return records

    def close(self) -> None:
        """End the subscription; what is queued can still be taken."""
        self._closed = True
        self._subscribers.discard(self)
        self._wake.set()

    async def __aiter__(self) -> AsyncIterator[Record]:
        while records := await self.take():
            for record in records:
                yield record

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
