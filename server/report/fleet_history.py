"""What a building's fleet did in a span of its journal, gathered from the events of one site."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import singledispatchmethod
from uuid import UUID

from mend.fleet.requests import STATUS, RequestStatus
from mend.server.fleets.leg_task import LegStage, run_of
from mend.server.journal import events as ev
from mend.server.report.span import Span

TYPES = (
    "request_changed",
    "plan_changed",
    "fleet_told",
    "leg_begun",
    "leg_ended",
    "run_started",
    "run_finished",
    "run_failed",
    "run_aborted",
    "node_started",
    "node_done",
    "node_reset",
    "node_left_out",
    "step_started",
    "issue_raised",
    "dialogue_opened",
    "escalated",
    "resolved",
    "robot_lost",
    "robot_back",
    "robot_resumed",
)
"""The types of the events that it is gathered from."""


@dataclass(slots=True)
class RequestRecord:
    """One request; `asked` is how it was made, `now` how far it was at the end of the span."""

    asked: ev.RequestChanged
    now: ev.RequestChanged
    asked_within: bool
    over_s: float | None = None
    legs: list["LegRecord"] = field(default_factory=list, repr=False, compare=False)
    """In the order in which they began."""
    transfer: ev.PlannedTransfer | None = None
    """What its latest plan said of its changing robots."""

    @property
    def kind(self) -> str:
        return str(self.now.what.get("kind", "unknown"))

    @property
    def status(self) -> RequestStatus:
        return RequestStatus(self.now.status)

    @property
    def wanted_s(self) -> float:
        """From when on it was wanted, by the site's clock."""
        return max(self.asked.at_s, float(self.asked.what.get("earliest_s") or 0.0))


@dataclass(slots=True)
class LegRecord:
    """One leg, and the events of the runs that carried it out, each in order."""

    begun: ev.LegBegun
    ended: ev.LegEnded | None = None
    runs: dict[LegStage, list[ev.Event]] = field(default_factory=dict)
    request: RequestRecord | None = None
    over_before: bool = False
    """Whether it was over before the span."""

    @property
    def kind(self) -> str:
        """The kind of request that it is for."""
        return "unknown" if self.request is None else self.request.kind

    @property
    def floors(self) -> set[str]:
        """Where it began, and where it led to."""
        return {each.split("/", 1)[0] for each in (self.begun.start, self.begun.place)}


@dataclass(slots=True)
class DialogueRecord:
    """One dialogue of a run of the site."""

    opened: ev.DialogueOpened
    resolved: ev.Resolved | None = None
    escalated: bool = False

    @property
    def helped(self) -> bool:
        """Whether a person has."""
        return self.resolved is not None and self.resolved.helped


@dataclass(slots=True)
class FleetHistory:
    """All times in seconds of the site's clock. `legs`: those that were not over before the span.

    `begins_s`, `ends_s`: the span by that clock; where it is said by the calendar, or not at all,
    from the first event in it to the last.
    """

    site: UUID
    begins_s: float = 0.0
    ends_s: float = 0.0
    requests: list[RequestRecord] = field(default_factory=list)
    legs: list[LegRecord] = field(default_factory=list)
    dialogues: dict[UUID, DialogueRecord] = field(default_factory=dict)
    plans: list[ev.PlanChanged] = field(default_factory=list)
    told: list[ev.FleetTold] = field(default_factory=list)
    within: list[ev.FleetEvent] = field(default_factory=list)
    _stages: dict[UUID, tuple[LegRecord, LegStage]] = field(default_factory=dict)
    _asked: dict[str, RequestRecord] = field(default_factory=dict)
    """The latest request of each name."""
    _open: dict[tuple[str, int], LegRecord] = field(default_factory=dict)
    _runs: set[UUID] = field(default_factory=set)

    @classmethod
    def of(cls, site: UUID, events: Sequence[ev.Event], span: Span) -> "FleetHistory":
        """What events, in the order of their journal, tell of a site's fleet."""
        history = cls(site)
        mine = [e for e in events if not isinstance(e, ev.SiteEvent) or e.site == site]
        for event, within in span.up_to_end(mine):
            history._take(event, within)
        history.legs = [each for each in history.legs if not each.over_before]
        # A change of plan may be told a little after what came of it.
        times_s = [each.at_s for each in history.within]
        history.begins_s, history.ends_s = min(times_s, default=0.0), max(times_s, default=0.0)
        if isinstance(span.begin, float):
            history.begins_s = span.begin
        if isinstance(span.end, float):
            known_s = (each.at_s for each in mine if isinstance(each, ev.FleetEvent))
            history.ends_s = min(span.end, max(known_s, default=0.0))
        return history

    @property
    def asked(self) -> list[RequestRecord]:
        """The requests that were made in the span."""
        return [each for each in self.requests if each.asked_within]

    @property
    def ended(self) -> list[tuple[LegRecord, ev.LegEnded]]:
        """The legs that ended in the span."""
        return [(each, each.ended) for each in self.legs if each.ended is not None]

    # --- Taking events ------------------------------------------------------------------------

    def _take(self, event: ev.Event, within: bool) -> None:
        if isinstance(event, ev.FleetEvent) and within:
            self.within.append(event)
        stage = self._stages.get(event.run)
        if stage is not None:
            stage[0].runs.setdefault(stage[1], []).append(event)
        self._note(event, within)

    @singledispatchmethod
    def _note(self, event: ev.Event, within: bool) -> None:
        """Events that are only told by the leg of which they are, or not at all."""

    @_note.register
    def _(self, event: ev.RequestChanged, within: bool) -> None:
        record = self._asked.get(event.request)
        if record is None or record.over_s is not None:
            # Who is done with a name may use it again.
            record = self._asked[event.request] = RequestRecord(event, event, within)
            self.requests.append(record)
        record.now = event
        record.over_s = event.at_s if STATUS.is_last(record.status) else None

    @_note.register
    def _(self, event: ev.LegBegun, within: bool) -> None:  # noqa: ARG002
        leg = LegRecord(event, request=self._asked.get(event.booking))
        self.legs.append(leg)
        if leg.request is not None:
            leg.request.legs.append(leg)
        self._open[event.robot, event.number] = leg
        for stage in LegStage:
            self._stages[run_of(self.site, event.robot, event.number, stage)] = leg, stage

    @_note.register
    def _(self, event: ev.LegEnded, within: bool) -> None:
        leg = self._open.pop((event.robot, event.number), None)
        if leg is None:
            return
        leg.ended, leg.over_before = event, not within

    @_note.register
    def _(self, event: ev.PlanChanged, within: bool) -> None:
        self.plans += [event] if within else []
        for each in event.transfers:
            if each.request in self._asked:
                self._asked[each.request].transfer = each

    @_note.register
    def _(self, event: ev.FleetTold, within: bool) -> None:
        self.told += [event] if within else []

    @_note.register
    def _(self, event: ev.RunStarted, within: bool) -> None:  # noqa: ARG002
        if event.site == self.site:
            self._runs.add(event.run)

    @_note.register
    def _(self, event: ev.DialogueOpened, within: bool) -> None:
        if within and event.run in self._runs:
            self.dialogues[event.dialogue] = DialogueRecord(event)

    @_note.register
    def _(self, event: ev.Escalated, within: bool) -> None:  # noqa: ARG002
        if event.dialogue in self.dialogues:
            self.dialogues[event.dialogue].escalated = True

    @_note.register
    def _(self, event: ev.Resolved, within: bool) -> None:  # noqa: ARG002
        if event.dialogue in self.dialogues:
            self.dialogues[event.dialogue].resolved = event
