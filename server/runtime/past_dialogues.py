"""Dialogues of the past, each from its own events: the run that it belonged to is not folded."""

import logging
import re
from collections.abc import Mapping, Sequence
from itertools import groupby
from uuid import UUID

from mend.dialogue.script import Script
from mend.server.journal import events as ev
from mend.server.journal.journal import JournalReadError
from mend.server.journal.run_index import IndexedDialogue, RunIndex
from mend.server.journal.stored_event import read_event
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.turns import Turns

PAGE = 500
OF_DIALOGUE = re.compile(r'"dialogue":"([^"]+)"')

log = logging.getLogger(__name__)


class PastDialogues:
    """Reads dialogues of runs that are not in memory."""

    def __init__(self, index: RunIndex, scripts: Mapping[str, Script]) -> None:
        self._index = index
        self._scripts = scripts

    async def read(self, wanted: Sequence[IndexedDialogue]) -> dict[UUID, DialogueState]:
        """Their last states, by id; without those that cannot be read."""
        found: dict[UUID, DialogueState] = {}
        by_run = sorted(wanted, key=lambda each: (str(each.run), each.opened))
        for run, dialogues in groupby(by_run, key=lambda each: each.run):
            try:
                found |= await self._of_run(run, list(dialogues))
            except JournalReadError as error:
                log.error("dialogues of run %s cannot be read: %s", run, error)
        return found

    async def _of_run(
        self, run: UUID, wanted: Sequence[IndexedDialogue]
    ) -> dict[UUID, DialogueState]:
        folded = _Dialogues({str(each.dialogue) for each in wanted}, self._scripts)
        after, turns = await self._index.raised_before(wanted[0]) - 1, Turns()
        while rows := await self._index.about_dialogues(run, after, PAGE):
            for seq, version, text in rows:
                folded.take(seq, version, text)
                await turns.pass_on()
            after = rows[-1][0]
        return folded.states


class _Dialogues:
    """Dialogues of one run, folded from its events in their order."""

    def __init__(self, wanted: set[str], scripts: Mapping[str, Script]) -> None:
        self.states: dict[UUID, DialogueState] = {}
        self._wanted = wanted
        self._scripts = scripts
        self._issue: tuple[int, int, str] | None = None

    def take(self, seq: int, version: int, text: str) -> None:
        named = OF_DIALOGUE.search(text)
        if named is None:
            self._issue = seq, version, text
        elif named.group(1) in self._wanted:
            try:
                self._fold(read_event(seq, text, version))
            except Exception as error:
                # Whatever it trips over: that dialogue cannot be read, and others can.
                log.error("dialogue %s cannot be read: %s", named.group(1), error)
                self._wanted.discard(named.group(1))
                self.states.pop(UUID(named.group(1)), None)

    def _fold(self, event: ev.Event) -> None:
        match event:
            case ev.DialogueOpened():
                assert self._issue is not None, "a dialogue opens right after its issue was raised"
                seq, version, text = self._issue
                raised = read_event(seq, text, version)
                assert isinstance(raised, ev.IssueRaised), "only issues name no dialogue"
                self.states[event.dialogue] = DialogueState.begun(event, raised, self._scripts)
            case ev.DialogueEvent() | ev.ClipRecorded():
                self.states[event.dialogue].fold(event)
