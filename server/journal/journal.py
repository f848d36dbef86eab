"""The journal: the append-only record of every event of every run, behind one narrow interface."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol
from uuid import UUID

from mend.errors import MendError
from mend.server.journal.chain import Break, Seal
from mend.server.journal.events import Event
from mend.server.journal.issue_index import IssueIndex
from mend.server.journal.keyed_request import FirstAnswer, KeptRequest, KeyedRequest
from mend.server.journal.run_index import RunIndex
from mend.server.journal.run_statistics import RunStatisticsIndex
from mend.server.journal.subscriptions import DEFAULT_CAPACITY, Record, Subscription
from mend.server.journal.trouble import Trouble


@dataclass(frozen=True, slots=True)
class Receipt:
    """That a robot's report was received; committed with what follows from it."""

    robot: str
    boot: str
    seq: int


@dataclass(frozen=True, slots=True)
class Document:
    """An uploaded file; one of the same kind and name is replaced. `text` None: it is deleted."""

    kind: str
    name: str
    text: str | None


@dataclass(frozen=True, slots=True)
class Entry:
    """What is committed together, all or nothing.

    `world` replaces the latest world state of a run, or of a site (`world_run` says whose);
    `pictures` are JPEGs.
    `world_forgotten`: of whom no world state is kept any more.
    `tree` is the JSON of the tree of its one event, `run_started`, in which that is left empty: a
    large tree is never made of objects only to be written.
    With events whose author asked under an idempotency key that request is kept.
    """

    events: Sequence[Event] = ()
    tree: str | None = None
    receipt: Receipt | None = None
    world_run: UUID | None = None
    world: Mapping[str, Any] | None = None
    pictures: Mapping[UUID, bytes] = field(default_factory=dict)
    document: Document | None = None
    world_forgotten: UUID | None = None


@dataclass(frozen=True, slots=True)
class UnreadableEvent:
    """An event that cannot be read, and the sentence that says why; `run` None: it is of none."""

    seq: int
    why: str
    run: UUID | None = None


Fold = Callable[[list[Event]], None]
"""Changes the state as committed events say."""


class Journal(Protocol):
    """Committed before it is published: `append` returns when the entry is durable."""

    @property
    def head(self) -> int:
        """The `seq` of the last committed event; 0 when there is none."""
        ...

    @property
    def trouble(self) -> Trouble:
        """Whether it can be written."""
        ...

    async def append(
        self, entry: Entry, fold: Fold | None = None, *, patient: bool = False
    ) -> list[Event]:
        """Commit an entry and return its events with their numbers, which have no gaps.

        `fold` is called with them once they are committed, in the same step in which they are
        published: whoever hears of an event finds the state already changed. What it raises this
        raises, though the entry is committed.
        Published to subscribers in the order of `seq`, after the commit. Raises
        `JournalClosedError` after `close`, `DuplicateReceiptError` if the receipt is there already
        (nothing of the entry is then committed), `JournalWriteError` if it could not be written;
        who is `patient` waits until it can be. A cancelled caller does not take its entry back.
        """
        ...

    async def read(self, after: int, limit: int, run: UUID | None = None) -> list[Event]:
        """Up to `limit` events with `seq` > `after`, in order; of one run if given.

        Raises `JournalReadError`, as all that reads.
        """
        ...

    async def read_records(self, after: int, limit: int, run: UUID | None = None) -> list[Record]:
        """A page of what `read` returns, as the JSON text of each event; empty only at the end.

        It has fewer than `limit` where they are long.
        """
        ...

    async def read_readable(
        self, after: int, limit: int, run: UUID | None = None
    ) -> list[Event | UnreadableEvent]:
        """Such a page of events; in the place of one that cannot be read, which one and why.

        Raises `JournalReadError` where not even the numbers of the events can be read.
        """
        ...

    def subscribe(self, after: int, capacity: int = DEFAULT_CAPACITY) -> Subscription:
        """Follow every event with `seq` > `after`; `capacity` may wait before it is cut off."""
        ...

    async def received(self, robot: str, boot: str) -> int:
        """The last `seq` received of a robot's boot; 0 when none."""
        ...

    async def world(self, run: UUID) -> dict[str, Any] | None:
        """The latest world state of a run, or of a site."""
        ...

    async def picture(self, picture: UUID) -> bytes | None: ...

    @property
    def index(self) -> RunIndex:
        """What runs and dialogues there are."""
        ...

    @property
    def issues(self) -> IssueIndex:
        """What issues were raised."""
        ...

    @property
    def statistics(self) -> RunStatisticsIndex:
        """What there is to tell of many runs."""
        ...

    @property
    def damage(self) -> Sequence[Break]:
        """Where it was found to be damaged when it was opened."""
        ...

    async def mark_unreadable(self, run: UUID, why: str) -> None:
        """Say in the index that a run's events cannot be read."""
        ...

    async def mark_readable(self, run: UUID, status: str) -> None:
        """Take that back: the run has a status again."""
        ...

    async def is_whole(self, run: UUID) -> bool:
        """Whether what a run's events were committed with is still as it was written."""
        ...

    async def seals(self, seqs: Sequence[int]) -> dict[int, Seal]:
        """What the chain says of events that are in the journal, and whether it holds there."""
        ...

    async def pruned_through(self) -> int:
        """The highest `seq` that was pruned; 0 if none was. Before it events may be missing."""
        ...

    async def find_request(self, principal: str, key: str, since: float) -> KeptRequest | None:
        """The request that somebody made under a key, if that was after `since` (s of 1970)."""
        ...

    async def keep_answer(
        self, request: KeyedRequest, answer: FirstAnswer | None, most: int, since: float
    ) -> int:
        """Add what a request was answered, and forget what need not be kept.

        That is all requests from before `since`, and of this principal all but the latest `most`.
        Returns how many of theirs went for being too many.
        """
        ...

    async def documents(self, kind: str) -> dict[str, str]:
        """The texts of uploaded files of a kind, by name."""
        ...

    def close(self) -> None: ...


class JournalClosedError(MendError):
    """The journal no longer takes entries."""


class JournalReadError(MendError):
    """Something of the journal cannot be read; the message says why."""


class JournalWriteError(MendError):
    """An entry could not be made durable; nothing of it was committed or published."""


class DuplicateReceiptError(MendError):
    """This report was received before."""
