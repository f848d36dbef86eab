"""The states of runs as the journal has them, at any event of the past."""

from collections import OrderedDict
from collections.abc import Mapping
from uuid import UUID

from mend.dialogue.script import Script
from mend.errors import UnreadableError
from mend.server.journal import events as ev
from mend.server.journal.journal import Journal, JournalReadError
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import Record
from mend.server.runtime.journaled_tree import read_started
from mend.server.runtime.run_state import RunState
from mend.server.runtime.shared_work import SharedWork
from mend.server.turns import Turns
from mend.tasks.node_table import NodeTable

MOST_KEPT = 16
PAGE = 1000
MOST_CHARS = 300


class History:
    """Folds journaled events again; keeps the states of the few ended runs asked for last."""

    def __init__(self, journal: Journal, scripts: Mapping[str, Script]) -> None:
        self._journal = journal
        self._scripts = scripts
        self._kept: OrderedDict[UUID, RunState] = OrderedDict()
        self._reading: SharedWork[UUID, RunState] = SharedWork()

    def kept(self, run: UUID) -> RunState | None:
        """The last state of a run, if it has ended and is kept."""
        if run in self._kept:
            self._kept.move_to_end(run)
        return self._kept.get(run)

    async def read(self, run: UUID) -> RunState:
        """The last state of a run as the journal has it, read once for all who ask meanwhile.

        Raises `UnreadableError`.
        """
        return await self._reading.of(run, lambda: self._read(run))

    async def _read(self, run: UUID) -> RunState:
        state = await self.at(run, None)
        if state is None:
            raise UnreadableError(f"the journal has no events of run {run}")
        self.keep(state)
        return state

    def keep(self, state: RunState) -> None:
        """Keep a state while it is asked for, if its run has ended."""
        if not state.status.ended:
            return
        self._kept[state.id] = state
        self._kept.move_to_end(state.id)
        while len(self._kept) > MOST_KEPT:
            self._kept.popitem(last=False)

    async def at(
        self, run: UUID, until: int | None, now: RunState | None = None
    ) -> RunState | None:
        """Fold a run's events again, up to `until`; None if it had not begun.

        `now` is a later state of it, if there is one: what never changes need not be read again.
        Raises `UnreadableError`.
        """
        state: RunState | None = None
        after, turns = 0, Turns()
        if now is not None:
            if until is not None and now.started.seq > until:
                return None
            state, after = now.begun_anew(), now.started.seq
        while records := await self._page(run, after):
            for record in records:
                if until is not None and record.seq > until:
                    return state
                state = await self._fold(run, state, record)
                await turns.pass_on()
            after = records[-1].seq
        return state

    async def _fold(self, run: UUID, state: RunState | None, record: Record) -> RunState:
        try:
            nodes = None
            if state is None:
                event, nodes = await read_started(record)
            else:
                event = read_event(record.seq, record.text)
        except JournalReadError as error:
            raise UnreadableError(f"run {run} cannot be read: {error}") from error
        return fold_event(run, state, event, self._scripts, nodes)

    async def _page(self, run: UUID, after: int) -> list[Record]:
        try:
            return await self._journal.read_records(after, PAGE, run)
        except JournalReadError as error:
            raise UnreadableError(f"run {run} cannot be read: {error}") from error

    async def is_at(self, state: RunState, at: int) -> bool:
        """Whether a state is that of its run after the journal's event `at`."""
        seq = state.seq
        if seq > at:
            return False
        newer = await self._journal.read_records(seq, 1, state.id)
        # A running run may have gone on meanwhile.
        return state.seq == seq and (not newer or newer[0].seq > at)


def fold_event(
    run: UUID,
    state: RunState | None,
    event: ev.Event,
    scripts: Mapping[str, Script],
    nodes: NodeTable | None = None,
) -> RunState:
    """The state of a run after one more event; `state` is None before its first.

    `nodes` are those of the first event's tree, if they were read already. Raises
    `UnreadableError` for an event that no run can have there.
    """
    if state is None and not isinstance(event, ev.RunStarted):
        raise UnreadableError(f"run {run} cannot be read: its first event is not 'run_started'")
    try:
        if state is None:
            assert isinstance(event, ev.RunStarted), "looked at above"
            return RunState(event, scripts, nodes)
        state.fold(event)
    except Exception as error:
        # Whatever a state trips over: the event does not fit what came before it.
        kind = vars(event).get("type", "?")
        raise UnreadableError(
            f"run {run} cannot be read: event {event.seq} ({kind}) does not fit what came before "
            f"it ({type(error).__name__}: {' '.join(str(error).split())[:MOST_CHARS]})"
        ) from error
    return state
