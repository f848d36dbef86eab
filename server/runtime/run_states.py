"""The states of all runs: of those that go on in memory, of others as the journal has them."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Literal
from uuid import UUID

from mend.dialogue.script import Script
from mend.errors import NotFoundError, UnreadableError
from mend.server.journal.journal import Journal, JournalClosedError, JournalWriteError
from mend.server.journal.run_index import UNREADABLE, IndexedRun
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.history import History
from mend.server.runtime.past_dialogues import PastDialogues
from mend.server.runtime.past_states import PastStates
from mend.server.runtime.run_state import RunState


class RunStates:
    """Finds runs and their dialogues, wherever they are.

    What cannot be read is listed as unreadable from then on, and as readable once it is again.
    """

    def __init__(self, journal: Journal, scripts: Mapping[str, Script]) -> None:
        self._journal = journal
        self._going_on: dict[UUID, RunState] = {}
        self._history = History(journal, scripts)
        self._past = PastStates(self._history)
        self._past_dialogues = PastDialogues(journal.index, scripts)

    # --- Runs that go on ----------------------------------------------------------------------

    def add(self, state: RunState) -> None:
        """A run goes on from here: from now on this is its state."""
        self._going_on[state.id] = state

    def let_go(self, state: RunState) -> None:
        """Of runs that have ended only a few are kept in memory."""
        if state.status.ended and self._going_on.pop(state.id, None) is not None:
            self._history.keep(state)

    def going_on(self, run: UUID) -> RunState | None:
        """The state of a run that goes on; None for every other one."""
        return self._going_on.get(run)

    async def left_by_the_last_service(self) -> list[IndexedRun]:
        """The runs that had not ended when the service stopped, in the order in which they began.

        Without those that were found to be damaged, which are listed as unreadable.
        """
        damaged = {run: each.sentence for each in self._journal.damage for run in each.runs}
        for run, why in damaged.items():
            with suppress(ValueError):
                await self._cannot_read(UUID(run), f"run {run} is damaged: {why}")
        going_on = await self._journal.index.going_on()
        return [each for each in going_on if str(each.run) not in damaged]

    # --- All runs -----------------------------------------------------------------------------

    async def find(self, run: UUID) -> RunState:
        """The last state of a run. Raises `NotFoundError` or `UnreadableError`."""
        if run in self._going_on:
            return self._going_on[run]
        # Looked for in the index first: what is kept in memory may have been pruned.
        indexed = await self._journal.index.find(run)
        if indexed is None:
            pruned = await self._journal.pruned_through()
            hint = "; ended runs have been pruned from this journal" if pruned else ""
            raise NotFoundError(f"there is no run {run}{hint}")
        if run in self._going_on:
            return self._going_on[run]
        return self._history.kept(run) or await self.read(indexed)

    async def read(self, indexed: IndexedRun) -> RunState:
        """The last state of a run as the journal has it. Raises `UnreadableError`."""
        doubted = indexed.status == UNREADABLE
        if doubted and not await self._journal.is_whole(indexed.run):
            raise UnreadableError(indexed.why or f"run {indexed.run} cannot be read")
        try:
            state = await self._history.read(indexed.run)
        except UnreadableError as error:
            if not doubted:
                await self._cannot_read(indexed.run, str(error))
            raise
        if doubted:
            with suppress(JournalWriteError, JournalClosedError):
                await self._journal.mark_readable(indexed.run, state.status)
        return state

    async def _cannot_read(self, run: UUID, why: str) -> None:
        """Have a run listed as unreadable from now on."""
        with suppress(JournalWriteError, JournalClosedError):
            await self._journal.mark_unreadable(run, why)

    async def open_at(self, seq: int) -> list[RunState]:
        """The states after event `seq` of the runs that had begun and not ended, and can be read.

        In the order in which they began.
        """
        states = []
        for run in await self._journal.index.open_at(seq):
            with suppress(UnreadableError):
                state = await self._at(run, seq)
                if state is not None and not state.status.ended:
                    states.append(state)
        return states

    async def _at(self, run: UUID, seq: int) -> RunState | None:
        state = self._going_on.get(run)
        if state is not None and await self._history.is_at(state, seq):
            return state
        return await self._past.at(run, seq, state)

    # --- Dialogues ----------------------------------------------------------------------------

    def all_going_on(self) -> list[RunState]:
        """The states of all runs that go on."""
        return list(self._going_on.values())

    def lost_robots(self) -> list[tuple[UUID, str]]:
        """The robots that are gone, with their runs, where no script answers for people."""
        states = (state for state in self._going_on.values() if state.live)
        return [(state.id, robot) for state in states for robot in sorted(state.lost)]

    def open_dialogues(self) -> Iterator[DialogueState]:
        return (each for state in self._going_on.values() for each in state.open_dialogues)

    async def find_dialogue(self, dialogue: UUID) -> DialogueState:
        """A dialogue of any run. Raises `NotFoundError` or `UnreadableError`."""
        known = self._known_dialogue(dialogue)
        if known is not None:
            return known
        found = await self._journal.index.dialogue(dialogue)
        past = {} if found is None else await self._past_dialogues.read([found])
        if dialogue in past:
            return past[dialogue]
        run = await self._journal.index.run_of(dialogue)
        if run is not None:
            # That says what is wrong with it, or that nothing is any more.
            state = await self.find(run)
            if dialogue in state.dialogues:
                return state.dialogues[dialogue]
        raise NotFoundError(f"there is no dialogue {dialogue}")

    async def page_of_dialogues(
        self, status: Literal["closed"] | None, limit: int, offset: int
    ) -> list[DialogueState]:
        """A page of dialogues, oldest first; without those that cannot be read."""
        found = await self._journal.index.dialogues(status, limit, offset)
        now = {each: self._known_dialogue(each.dialogue) for each in found}
        past = await self._past_dialogues.read([each for each in found if now[each] is None])
        read = (now[each] or past.get(each.dialogue) for each in found)
        return [each for each in read if each is not None]

    def _known_dialogue(self, dialogue: UUID) -> DialogueState | None:
        """A dialogue of a run that goes on."""
        for state in self._going_on.values():
            if dialogue in state.dialogues:
                return state.dialogues[dialogue]
        return None
