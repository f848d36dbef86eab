"""What a report tells of a run, gathered from its events in one pass."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import singledispatchmethod
from typing import Literal
from uuid import UUID

from mend.dialogue.script import CloseReason
from mend.server.journal import events as ev
from mend.tasks.resolution import Resolution

RunEnd = ev.RunFinished | ev.RunFailed | ev.RunAborted

Ending = Literal["done", "put back", "left out", "cut off"]


@dataclass(slots=True)
class AttemptStep:
    """One step of a behavior as it was carried out; times in seconds of the run's clock."""

    number: int
    name: str
    start_s: float
    end_s: float | None = None


@dataclass(slots=True)
class Attempt:
    """One attempt at a leaf, from its choice until it was done or put back."""

    started: ev.NodeStarted
    end_s: float | None = None
    ending: Ending = "cut off"
    steps: list[AttemptStep] = field(default_factory=list)

    def end_step(self, time_s: float) -> None:
        """The step under way, if any, ends here."""
        if self.steps and self.steps[-1].end_s is None:
            self.steps[-1].end_s = time_s


@dataclass(slots=True)
class Fault:
    """One issue: what led to it, the dialogue about it and how it was resolved."""

    raised: ev.IssueRaised
    story: list[ev.Event] = field(default_factory=list)
    resolution: Resolution | None = None
    reason: CloseReason | None = None
    end_s: float | None = None

    @property
    def outcome(self) -> str:
        """The resolution, else why its dialogue closed, else that it is still open."""
        return str(self.resolution or self.reason or "open")


class RunRecord:
    """A run's executions, faults and interventions, in order.

    Raises `ValueError` unless the events begin with the start of a run and are all of that run.
    """

    def __init__(self, events: Sequence[ev.Event]) -> None:
        if not events or not isinstance(events[0], ev.RunStarted):
            raise ValueError("expected the events of a run, from its run_started on")
        self.started = events[0]
        if any(each.run != self.started.run for each in events):
            raise ValueError(f"expected events of run {self.started.run} alone")
        self.events = events
        self.end: RunEnd | None = None
        self.executions: list[Attempt] = []
        self.faults: list[Fault] = []
        self.interventions: list[ev.InterventionDone] = []
        self.done: dict[str, ev.NodeDone] = {}
        self.left_out: dict[str, ev.NodeLeftOut] = {}
        self.undone: list[ev.NodeUndone] = []
        self._current: dict[str, Attempt] = {}
        self._dialogues: dict[UUID, Fault] = {}
        for event in events:
            self._take(event)
        self.end_s = max(each.time for each in events)

    @property
    def status(self) -> Literal["finished", "failed", "aborted", "unfinished"]:
        match self.end:
            case ev.RunFinished():
                return "finished"
            case ev.RunFailed():
                return "failed"
            case ev.RunAborted():
                return "aborted"
        return "unfinished"

    @singledispatchmethod
    def _take(self, event: ev.Event) -> None:
        """Events that a report tells in its transcript alone."""

    @_take.register
    def _(self, event: ev.NodeStarted) -> None:
        execution = Attempt(event)
        self.executions.append(execution)
        self._current[event.node] = execution

    @_take.register
    def _(self, event: ev.StepStarted) -> None:
        execution = self._current.get(event.node)
        if execution is not None:
            execution.end_step(event.time)
            execution.steps.append(AttemptStep(event.step, event.step_name, event.time))

    @_take.register
    def _(self, event: ev.NodeDone) -> None:
        self.done[event.node] = event
        self._end_execution(event, "done")

    @_take.register
    def _(self, event: ev.NodeLeftOut) -> None:
        self.left_out[event.node] = event
        self._end_execution(event, "left out")

    @_take.register
    def _(self, event: ev.NodeReturned | ev.LeafTriedAgain) -> None:
        self.left_out.pop(event.node, None)

    @_take.register
    def _(self, event: ev.NodeUndone) -> None:
        self.undone.append(event)
        self.done.pop(event.node, None)
        self.left_out.pop(event.node, None)

    @_take.register
    def _(self, event: ev.NodeReset) -> None:
        self._end_execution(event, "put back")

    def _end_execution(self, event: ev.NodeEvent, ending: Ending) -> None:
        execution = self._current.pop(event.node, None)
        if execution is not None:
            execution.end_step(event.time)
            execution.end_s, execution.ending = event.time, ending

    @_take.register
    def _(self, event: ev.IssueRaised) -> None:
        fault = Fault(event, self._deeds_before(event))
        self.faults.append(fault)
        execution = self._current.get(event.node)
        if event.interrupts and execution is not None:
            execution.end_step(event.time)

    def _deeds_before(self, raised: ev.IssueRaised) -> list[ev.Event]:
        """What a person did to the object in this attempt, and so perhaps caused."""
        execution = self._current.get(raised.node)
        since = execution.started.seq if execution else raised.seq
        told = {each.seq for fault in self.faults for each in fault.story}
        return [
            each
            for each in self.interventions
            if each.seq > since and each.object == raised.object and each.seq not in told
        ]

    @_take.register
    def _(self, event: ev.DialogueOpened) -> None:
        about = [each for each in self.faults if each.raised.node == event.node]
        if about:
            self._dialogues[event.dialogue] = about[-1]

    @_take.register
    def _(self, event: ev.DialogueEvent) -> None:
        fault = self._dialogues.get(event.dialogue)
        if fault is None:
            return
        fault.story.append(event)
        if isinstance(event, ev.Resolved):
            fault.resolution = event.resolution
        elif isinstance(event, ev.DialogueClosed):
            fault.reason, fault.end_s = event.reason, event.time

    @_take.register
    def _(self, event: ev.InterventionDone) -> None:
        self.interventions.append(event)
        for fault in self._dialogues.values():
            if fault.end_s is None and event.object in (fault.raised.object, None):
                fault.story.append(event)

    @_take.register(ev.RunFinished)
    @_take.register(ev.RunFailed)
    @_take.register(ev.RunAborted)
    def _(self, event: RunEnd) -> None:
        self.end = event
