"""What there is to see of runs: a page of them, one, or all at a moment."""

import asyncio
from array import array
from collections.abc import Mapping
from uuid import UUID

import numpy as np

from mend.errors import NotFoundError
from mend.server.journal.journal import Journal
from mend.server.journal.run_index import UNREADABLE, RunPage
from mend.server.runtime.choosing import potentials_for
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState
from mend.server.runtime.run_states import RunStates
from mend.server.runtime.run_views import RunViewing, dialogue_view, summary, summary_of_indexed
from mend.server.runtime.views import RunStatus, RunSummary, RunView, Snapshot


class RunLookup:
    """Reads runs as they are now; those that go on are in `runs`, which others change."""

    def __init__(self, journal: Journal, states: RunStates, runs: Mapping[UUID, Run]) -> None:
        self._journal, self._states, self._runs = journal, states, runs
        self._writing_json = asyncio.Lock()

    async def runs(self, page: RunPage) -> list[RunSummary]:
        """A page of runs, newest first. Raises `NotFoundError` for a page after an unknown run."""
        if page.before is not None and await self._journal.index.find(page.before) is None:
            raise NotFoundError(f"there is no run {page.before} after which the list could go on")
        trouble = self._journal.trouble.reason
        summaries = []
        for indexed in await self._journal.index.page(page):
            state = self._states.going_on(indexed.run)
            if state is None or indexed.status == UNREADABLE:
                summaries.append(summary_of_indexed(indexed))
            else:
                summaries.append(summary(state, self._time(state), trouble))
        return summaries

    async def count_runs(self) -> Mapping[RunStatus, int]:
        """How many runs there are of each status."""
        counts = await self._journal.index.counts()
        return {status: counts.get(status, 0) for status in RunStatus}

    async def run(self, run: UUID) -> RunView:
        """Everything about one run. Raises `NotFoundError` or `UnreadableError`."""
        return await self._viewing(await self._states.find(run)).view()

    async def run_summary(self, run: UUID) -> RunSummary:
        """One run without its nodes. Raises `NotFoundError` or `UnreadableError`."""
        if self._states.going_on(run) is None:
            indexed = await self._journal.index.find(run)
            if indexed is not None and RunStatus(indexed.status).ended:
                return summary_of_indexed(indexed)
        return self.summary(await self._states.find(run))

    def lost_robots(self) -> list[tuple[UUID, str]]:
        """The robots that are gone, with their runs, where no script answers for people."""
        return self._states.lost_robots()

    async def run_json(self, run: UUID) -> list[bytes]:
        """What `run` returns, in JSON, in pieces."""
        # Each passes the loop on after a piece: all at once would make others wait for all of them.
        async with self._writing_json:
            return await self._viewing(await self._states.find(run)).json()

    def summary(self, state: RunState) -> RunSummary:
        """Of a run that is in memory."""
        return summary(state, self._time(state), self._journal.trouble.reason)

    async def snapshot(self, seq: int | None) -> Snapshot:
        """The state after event `seq`, or after the last one without it."""
        head = self._journal.head
        at = head if seq is None else min(seq, head)
        states = await self._states.open_at(at)
        return Snapshot(
            seq=at,
            runs=[self.summary(each) for each in states],
            dialogues=[dialogue_view(d) for each in states for d in each.open_dialogues],
        )

    def _viewing(self, state: RunState) -> RunViewing:
        leaves = np.asarray(state.tree.leaves, dtype=np.int64)
        potentials = np.zeros(len(state.tree))
        run = self._runs.get(state.id)
        for proxy in run.proxies.values() if run else ():
            of_side = potentials_for(state, proxy, leaves)
            potentials[leaves] = np.maximum(potentials[leaves], of_side)
        trouble = self._journal.trouble.reason
        return RunViewing(state, self._time(state), array("d", potentials.tobytes()), trouble)

    def _time(self, state: RunState) -> float:
        run = self._runs.get(state.id)
        return run.context.clock.now() if run and not state.status.ended else state.time
