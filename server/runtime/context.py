"""What the parts of a running run share: its state, clock, journal and settings."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any
from uuid import UUID

from mend.server.journal.events import Event
from mend.server.journal.journal import Entry, Journal, Receipt
from mend.server.limits import Limits
from mend.server.refusals import Refusals
from mend.server.runtime.clock import RunClock
from mend.server.runtime.run_state import RunState


@dataclass(frozen=True, slots=True)
class RunSettings:
    """How patient a run is. Seconds of the run's clock, but for `robot_lost_timeout_s` (wall).

    `person_leaf_s`: so long a person may take for a leaf that they do themselves.
    `max_helped_retries`: so often a robot tries one leaf again because somebody has helped.
    `max_times_gone`: so often a leaf is done again whose result was seen gone. Such a leaf has not
    failed, so it is no attempt; the bound is for a person who takes it away each time.
    `record_before_fault_s`, `record_after_fault_s`, `recording_period_s`: how long cameras are
    recorded around faults, and how long a picture comes after the other; in real time.
    """

    help_window_s: float = 30.0
    person_leaf_s: float = 120.0
    robot_lost_timeout_s: float = 60.0
    robot_silent_timeout_s: float = 600.0
    max_helped_retries: int = 20
    max_times_gone: int = 10
    claim_lease_s: float = 30.0
    record_before_fault_s: float = 0.0
    record_after_fault_s: float = 0.0
    recording_period_s: float = 0.5
    limits: Limits = field(default_factory=Limits)


class RunContext:
    """A run's state and the one way to change it: commit events, then fold them.

    While it is `patient`, a commit waits until the journal can be written; else it is refused.
    `followed` is called with what the state has followed.
    """

    def __init__(
        self,
        state: RunState,
        clock: RunClock,
        journal: Journal,
        settings: RunSettings,
        utc_now: Callable[[], datetime],
        refusals: Refusals,
        followed: Callable[[Sequence[Event]], None] = lambda _: None,
    ) -> None:
        self.state = state
        self.clock = clock
        self.settings = settings
        self.utc_now = utc_now
        self.refusals = refusals
        self._journal = journal
        self._followed = followed
        self.patient = True
        self._noting: asyncio.Task[list[Event]] | None = None

    @property
    def trouble(self) -> str | None:
        """Why the journal cannot be written now; None while it can be."""
        return self._journal.trouble.reason

    async def in_trouble(self) -> None:
        """Wait until the journal cannot be written."""
        await self._journal.trouble.begun()

    def stamp(self) -> dict[str, Any]:
        """What every event of this run has now."""
        return {"time": self.clock.now(), "wall_time": self.utc_now(), "run": self.state.id}

    async def commit(
        self,
        events: Sequence[Event],
        *,
        receipt: Receipt | None = None,
        world: Mapping[str, Any] | None = None,
        pictures: Mapping[UUID, bytes] | None = None,
    ) -> list[Event]:
        """Commit an entry; only then does the state follow."""
        entry = Entry(
            events=events,
            receipt=receipt,
            world_run=self.state.world_kept_as if world is not None else None,
            world=world,
            pictures=pictures or {},
        )

        def fold(numbered: list[Event]) -> None:
            for event in numbered:
                self.state.fold(event)
            self._followed(numbered)

        return await self._journal.append(entry, fold, patient=self.patient)

    def note(self, receipt: Receipt) -> None:
        """Commit the receipt of a report that says nothing new, beside what follows from it."""
        entry = Entry(receipt=receipt)
        self._noting = asyncio.create_task(self._journal.append(entry, patient=True))

    async def noted(self) -> None:
        """Wait until what was noted is committed. Raises `DuplicateReceiptError`."""
        noting, self._noting = self._noting, None
        if noting is not None:
            await noting
