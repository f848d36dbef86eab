"""Judges every sentence of a run's dialogues by where things really were when it was said.

The judge knows nothing of the runtime or the dialogues' code: it reads the journal's events, and
the states of the simulated world that were journaled beside them, as nobody in the run may.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from dialogue_claims import AT_PLACE_M, CHECKS, EFFECTS, Check
from dialogue_record import Moment, RunRecord

from mend.server.journal import events as ev


@dataclass(frozen=True, slots=True)
class Untruth:
    """One thing that was said or told and was not so."""

    seq: int
    what: str
    why: str


class DialogueJudge:
    """Compares what one run says with its world; `moments[i]` is that of `events[i]`."""

    def __init__(self, events: Sequence[ev.Event], moments: Sequence[Moment]) -> None:
        self._events = events
        self._record = RunRecord(events, moments)
        self.sentences = 0

    def judge(self) -> list[Untruth]:
        """Everything untrue, in order."""
        return [
            Untruth(event.seq, what, why)
            for index, event in enumerate(self._events)
            for what, why in self._wrong_in(index, event)
        ]

    def _wrong_in(self, index: int, event: ev.Event) -> Iterator[tuple[str, str]]:
        self._record.note(index)
        match event:
            case ev.Prompt(version=1):
                self.sentences += 1
                yield from self._wrong_said(index, event, event.text, CHECKS)
                for effect in [*(each.effect for each in event.answers), event.timeout_effect]:
                    yield from self._wrong_said(index, event, effect, EFFECTS)
            case ev.Resolved(helped=True):
                if not self._was_helped(index, event):
                    yield f"resolved {event.resolution}, helped", "nobody has helped"
            case ev.NodeDone():
                yield from self._wrong_doer(index, event)

    def _wrong_said(
        self, index: int, event: ev.Prompt, said: str, checks: Sequence[tuple[str, Check]]
    ) -> Iterator[tuple[str, str]]:
        for pattern, check in checks:
            found = re.search(pattern, said)
            why = check(self._record, index, event, found) if found else None
            if why:
                yield said, why

    # --- What events say ----------------------------------------------------------------------

    def _was_helped(self, index: int, event: ev.Resolved) -> bool:
        if event.resolution == "collab_finish":
            since = self._record.since_opened(index, event)
            return any(isinstance(each, ev.Answered) and each.answer == "yes" for each in since)
        return any(True for _ in self._record.deeds(index, event))

    def _wrong_doer(self, index: int, event: ev.NodeDone) -> Iterator[tuple[str, str]]:
        begun = max(
            i
            for i, each in enumerate(self._events[:index])
            if isinstance(each, ev.NodeStarted | ev.NodeTaken) and each.node == event.node
        )
        since = self._events[begun:index]
        deeds = [each for each in since if isinstance(each, ev.InterventionDone) and each.ok]
        brought = any(each.act in ("place", "move") for each in deeds)
        heard = any(
            isinstance(each, ev.Answered) and each.answer == "yes" and each.issue == "positioning"
            for each in since
        )
        if event.by == "human" and not brought:
            yield f"{event.name} is done by the human", "no person put it there"
        if event.by == "both" and not heard:
            yield f"{event.name} is done by both", "no person was heard to help"
        name = self._record.object_of(event.node)
        if name is not None and event.by != "found":
            off_m = max(self._record.offset(index, event.node, name))
            stolen = any(each.act == "steal" and each.object == name for each in deeds)
            if off_m > AT_PLACE_M and not stolen:
                yield f"{event.name} is done", f"it is {off_m:.3f} m off"
