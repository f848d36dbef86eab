"""The states of runs as the journal has them, at any event of the past."""

from collections.abc import Mapping
from typing import cast
from uuid import UUID

from dialogue.script import Script
from server.journal import events as ev
from server.journal.journal import Journal
from server.runtime.run_state import RunState


class History:
    """Folds journaled events again."""

    def __init__(self, journal: Journal, scripts: Mapping[str, Script]) -> None:
        self._journal = journal
        self._scripts = scripts

    async def at(self, run: UUID, until: int | None) -> RunState | None:
        """Fold a run's events again, up to `until`; None if it had not begun."""
        state: RunState | None = None
        after = 0
        while events := await self._journal.read(after, 1000, run):
            for event in events:
                if until is not None and event.seq > until:
                    return state
                if state is None:
                    state = RunState(cast(ev.RunStarted, event), self._scripts)
                else:
                    state.fold(event)
            after = events[-1].seq
        return state

    async def is_at(self, state: RunState, at: int) -> bool:
        """Whether a state is that of its run after the journal's event `at`."""
        seq = state.seq
        if seq > at:
            return False
        newer = await self._journal.read(seq, 1, state.id)
        # A running run may have gone on meanwhile.
        return state.seq == seq and (not newer or newer[0].seq > at)
